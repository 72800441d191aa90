(** * The verdict of a word of kicks, drifts and implicit midpoints, proven by computation

    force               == that of L1 + L2, of L1, or of L2
    letter              == K f [c1; c2; ...]: a kick, v -= (c1 F + c2 F^2 + ...) x / h with F = h^2 L; D c: a drift over c h; C f c: the
                           implicit midpoint rule over c h (Cayley's transform)
    word_matrix, solvable
                        == the product of the letters, first letter first, on (x, v); no midpoint has a pole
    word_verdict k letters h L1 L2
                        == a step h > 0 of x'' + (L1 + L2) x = 0 by these letters behaves as k says

    - [check k letters h L1 L2]  the computation in integers, a boolean;
    - [word_certificate]         check = true proves the verdict;
    - [certify_word]             the tactic that generated files use: one vm_compute.                  *)

From Kickdrift Require Import Vocabulary Algebra Stability Certificate.
From Coq Require Import Reals Qreals QArith Bool Lra Psatz.
From Coq Require Export List.
Export ListNotations.

Inductive force := All | First | Second.
Inductive letter := K (f : force) (powers : list Q) | D (time : Q) | C (f : force) (time : Q).
Arguments K _ _%Q.
Arguments D _%Q.
Arguments C _ _%Q.

(** ** Its meaning *)

Open Scope R_scope.

Definition stiffness (f : force) (L1 L2 : R) := match f with All => L1 + L2 | First => L1 | Second => L2 end.

(** c1 F + c2 F^2 + ... by Horner's rule. *)
Definition strength (F : R) (powers : list Q) := fold_right (fun c sum => (Q2R c + sum) * F) 0 powers.

(** The quarter that the midpoint rule adds and subtracts: c^2 F / 4. *)
Definition part (F : R) (c : Q) := Q2R c * Q2R c * F / 4.

Definition letter_matrix (h L1 L2 : R) (l : letter) : mat :=
  match l with
  | K f powers => kick (strength (h * h * stiffness f L1 L2) powers / h)
  | D c => drift (Q2R c * h)
  | C f c =>
      let F := h * h * stiffness f L1 L2 in
      let below := 1 + part F c in
      Mat ((1 - part F c) / below) (Q2R c * h / below) (- (Q2R c * F / h / below)) ((1 - part F c) / below)
  end.

Definition solvable_letter (h L1 L2 : R) (l : letter) : Prop :=
  match l with C f c => 1 + part (h * h * stiffness f L1 L2) c <> 0 | _ => True end.

Fixpoint word_matrix (h L1 L2 : R) (letters : list letter) : mat :=
  match letters with [] => one | l :: rest => word_matrix h L1 L2 rest ** letter_matrix h L1 L2 l end.

Definition solvable (h L1 L2 : R) (letters : list letter) := Forall (solvable_letter h L1 L2) letters.

Record word_verdict (k : kind) (letters : list letter) (h L1 L2 : R) : Prop := {
  word_step      : 0 < h;
  word_solvable  : solvable h L1 L2 letters;
  word_behaviour : behaves k (word_matrix h L1 L2 letters)
}.

(** ** The computation *)

Open Scope Q_scope.

Record qmat := QMat { qA : Q; qB : Q; qC : Q; qD : Q }.

Definition qstiffness (f : force) (L1 L2 : Q) := match f with All => L1 + L2 | First => L1 | Second => L2 end.
Definition qstrength (F : Q) (powers : list Q) := fold_right (fun c sum => Qred ((c + sum) * F)) 0 powers.
Definition qpart (F c : Q) := c * c * F / 4.

Definition qletter (h L1 L2 : Q) (l : letter) : qmat :=
  match l with
  | K f powers => QMat 1 0 (- (qstrength (h * h * qstiffness f L1 L2) powers / h)) 1
  | D c => QMat 1 (c * h) 0 1
  | C f c =>
      let F := h * h * qstiffness f L1 L2 in
      let below := 1 + qpart F c in
      QMat ((1 - qpart F c) / below) (c * h / below) (- (c * F / h / below)) ((1 - qpart F c) / below)
  end.

Definition qsolvable (h L1 L2 : Q) (l : letter) : bool :=
  match l with C f c => negb (Qeq_bool (1 + qpart (h * h * qstiffness f L1 L2) c) 0) | _ => true end.

(** Integers and their common denominator: fractions that are never reduced, since that would cost more than the product. *)
Record scaled := Scaled { entries : zmat; scale : Z }.

Open Scope Z_scope.

Definition whole (m : Z) (x : Q) := Qnum x * (m / QDen x).

Definition denominator (M : qmat) := Z.lcm (Z.lcm (QDen (qA M)) (QDen (qB M))) (Z.lcm (QDen (qC M)) (QDen (qD M))).

Definition times (M : qmat) (S : scaled) : scaled :=
  let m := denominator M in
  let a := whole m (qA M) in let b := whole m (qB M) in let c := whole m (qC M) in let d := whole m (qD M) in
  let N := entries S in
  Scaled (ZMat (a * zA N + b * zC N) (a * zB N + b * zD N) (c * zA N + d * zC N) (c * zB N + d * zD N)) (m * scale S).

(** The first letter acts first. *)
Definition run_word (h L1 L2 : Q) (letters : list letter) : scaled :=
  fold_left (fun S l => times (qletter h L1 L2 l) S) letters (Scaled (ZMat 1 0 0 1) 1).

Definition classify_trace (S : scaled) : kind :=
  let M := entries S in
  let identity := (zB M =? 0) && (zC M =? 0) in
  let twice := 2 * scale S in
  match zA M + zD M ?= twice with
  | Gt => Hyperbolic Plus
  | Eq => if identity then Coexistence Plus else Parabolic Plus
  | Lt =>
      match zA M + zD M ?= - twice with
      | Lt => Hyperbolic Minus
      | Eq => if identity then Coexistence Minus else Parabolic Minus
      | Gt => Elliptic
      end
  end.

Definition check (k : kind) (letters : list letter) (h L1 L2 : Q) : bool :=
  let S := run_word h L1 L2 letters in
  (0 <? Qnum h) && forallb (qsolvable h L1 L2) letters && (0 <? scale S) && same_kind (classify_trace S) k.

(** ** Soundness *)

Open Scope R_scope.
Local Arguments Qred _ : simpl never.
Local Arguments Qplus _ _ : simpl never.
Local Arguments Qminus _ _ : simpl never.
Local Arguments Qmult _ _ : simpl never.
Local Arguments Qdiv _ _ : simpl never.
Local Arguments Qopp _ : simpl never.

Definition real (M : qmat) := Mat (Q2R (qA M)) (Q2R (qB M)) (Q2R (qC M)) (Q2R (qD M)).

Lemma Q2R_red x : Q2R (Qred x) = Q2R x.
Proof. apply Qeq_eqR, Qred_correct. Qed.

Lemma Q2R_nonzero x : Q2R x <> 0 <-> ~ (x == 0)%Q.
Proof.
  split; intros N E; apply N.
  - apply Qeq_eqR in E; rewrite E; unfold Q2R; simpl; lra.
  - apply eqR_Qeq; rewrite E; unfold Q2R; simpl; lra.
Qed.

Lemma Q2R_4 : Q2R 4 = 4.
Proof. unfold Q2R; simpl; lra. Qed.

Lemma Q2R_1 : Q2R 1 = 1.
Proof. unfold Q2R; simpl; lra. Qed.

Lemma Q2R_0 : Q2R 0 = 0.
Proof. unfold Q2R; simpl; lra. Qed.

(** The integers are the scale times the entries. *)
Definition stands_for (S : scaled) (M : mat) :=
  IZR (zA (entries S)) = IZR (scale S) * mA M /\ IZR (zB (entries S)) = IZR (scale S) * mB M /\
  IZR (zC (entries S)) = IZR (scale S) * mC M /\ IZR (zD (entries S)) = IZR (scale S) * mD M.

Lemma whole_spec m x : (QDen x | m)%Z -> IZR (whole m x) = IZR m * Q2R x.
Proof.
  intros (n & ->); unfold whole, Q2R; rewrite Z.div_mul by discriminate.
  rewrite !mult_IZR; field; apply not_0_IZR; discriminate.
Qed.

Lemma times_spec L S M : stands_for S M -> stands_for (times L S) (real L ** M).
Proof.
  intros (A & B & E & D0); unfold stands_for, times; cbv zeta; cbn [entries scale zA zB zC zD].
  assert (dA : (QDen (qA L) | denominator L)%Z) by (eapply Z.divide_trans; [apply Z.divide_lcm_l | apply Z.divide_lcm_l]).
  assert (dB : (QDen (qB L) | denominator L)%Z) by (eapply Z.divide_trans; [apply Z.divide_lcm_r | apply Z.divide_lcm_l]).
  assert (dC : (QDen (qC L) | denominator L)%Z) by (eapply Z.divide_trans; [apply Z.divide_lcm_l | apply Z.divide_lcm_r]).
  assert (dD : (QDen (qD L) | denominator L)%Z) by (eapply Z.divide_trans; [apply Z.divide_lcm_r | apply Z.divide_lcm_r]).
  rewrite !plus_IZR, !mult_IZR, !whole_spec, A, B, E, D0 by assumption.
  unfold real, mul; simpl; repeat split; ring.
Qed.

Lemma real_stiffness f L1 L2 : Q2R (qstiffness f L1 L2) = stiffness f (Q2R L1) (Q2R L2).
Proof. destruct f; simpl; [apply Q2R_plus | reflexivity..]. Qed.

Lemma real_strength F powers : Q2R (qstrength F powers) = strength (Q2R F) powers.
Proof.
  induction powers as [|c rest IH]; simpl; [exact Q2R_0|].
  rewrite Q2R_red, Q2R_mult, Q2R_plus, IH; reflexivity.
Qed.

Lemma real_part F c : Q2R (qpart F c) = part (Q2R F) c.
Proof. unfold qpart, part; rewrite Q2R_div, !Q2R_mult, Q2R_4 by (unfold Qeq; simpl; discriminate); reflexivity. Qed.

Section Letters.
Variables (h L1 L2 : Q).
Hypothesis positive : 0 < Q2R h.
Let h0 : ~ (h == 0)%Q.
Proof. apply Q2R_nonzero; lra. Qed.

Lemma real_force f : Q2R (h * h * qstiffness f L1 L2) = Q2R h * Q2R h * stiffness f (Q2R L1) (Q2R L2).
Proof. rewrite !Q2R_mult, real_stiffness; reflexivity. Qed.

Lemma real_below f c :
  Q2R (1 + qpart (h * h * qstiffness f L1 L2) c) = 1 + part (Q2R h * Q2R h * stiffness f (Q2R L1) (Q2R L2)) c.
Proof. rewrite Q2R_plus, real_part, real_force, Q2R_1; reflexivity. Qed.

Lemma real_solvable l : qsolvable h L1 L2 l = true -> solvable_letter (Q2R h) (Q2R L1) (Q2R L2) l.
Proof.
  destruct l as [| |f c]; simpl; trivial.
  rewrite negb_true_iff, <- real_below; intros N; apply Q2R_nonzero; intros E.
  apply Qeq_bool_iff in E; congruence.
Qed.

Lemma real_letter l :
  qsolvable h L1 L2 l = true -> real (qletter h L1 L2 l) = letter_matrix (Q2R h) (Q2R L1) (Q2R L2) l.
Proof.
  intros S; pose proof (real_solvable l S) as N; destruct l as [f powers|c|f c]; unfold real; simpl in *.
  - unfold kick; rewrite Q2R_opp, Q2R_div, real_strength, real_force, Q2R_1, Q2R_0 by exact h0; reflexivity.
  - unfold drift; rewrite Q2R_mult, Q2R_1, Q2R_0; reflexivity.
  - rewrite <- real_below in *; apply Q2R_nonzero in N.
    rewrite Q2R_opp, !Q2R_div, !Q2R_mult by first [exact N | exact h0].
    rewrite Q2R_minus, Q2R_1, real_part, real_stiffness, real_force; reflexivity.
Qed.

Lemma run_spec letters : forallb (qsolvable h L1 L2) letters = true ->
  stands_for (run_word h L1 L2 letters) (word_matrix (Q2R h) (Q2R L1) (Q2R L2) letters).
Proof.
  intros S; unfold run_word.
  assert (G : forall N M, stands_for N M ->
    stands_for (fold_left (fun N l => times (qletter h L1 L2 l) N) letters N)
               (word_matrix (Q2R h) (Q2R L1) (Q2R L2) letters ** M)).
  { induction letters as [|l rest IH]; intros N M R; simpl in *.
    - replace (one ** M) with M; [exact R | destruct M; unfold mul, one; simpl; f_equal; ring].
    - apply andb_true_iff in S; destruct S as [Sl Sr].
      replace (word_matrix (Q2R h) (Q2R L1) (Q2R L2) rest ** letter_matrix (Q2R h) (Q2R L1) (Q2R L2) l ** M)
        with (word_matrix (Q2R h) (Q2R L1) (Q2R L2) rest ** (letter_matrix (Q2R h) (Q2R L1) (Q2R L2) l ** M))
        by (unfold mul; simpl; f_equal; ring).
      rewrite <- real_letter by assumption; apply IH; [assumption | apply times_spec, R]. }
  replace (word_matrix (Q2R h) (Q2R L1) (Q2R L2) letters)
    with (word_matrix (Q2R h) (Q2R L1) (Q2R L2) letters ** one)
    by (generalize (word_matrix (Q2R h) (Q2R L1) (Q2R L2) letters); intros [a b c d]; unfold mul, one; simpl; f_equal; ring).
  apply G; unfold stands_for; simpl; repeat split; ring.
Qed.
End Letters.

Lemma det_mul M N : det (M ** N) = det M * det N.
Proof. unfold det, mul; simpl; ring. Qed.

Lemma det_word h L1 L2 letters : 0 < h -> solvable h L1 L2 letters -> det (word_matrix h L1 L2 letters) = 1.
Proof.
  intros P; induction 1 as [|l rest S _ IH]; simpl; [unfold det; simpl; ring|].
  rewrite det_mul, IH; destruct l as [f powers|c|f c]; unfold det; simpl in *; try ring.
  unfold part in *; field; split; [|lra]; intros E; apply S; lra.
Qed.

Lemma classify_trace_sound S M : 0 < IZR (scale S) -> stands_for S M -> det M = 1 -> behaves (classify_trace S) M.
Proof.
  intros P (A & B & E & D0) one_det; unfold classify_trace.
  set (m := IZR (scale S)) in *.
  assert (T : IZR (zA (entries S) + zD (entries S)) = m * tr M) by (rewrite plus_IZR, A, D0; unfold tr; ring).
  assert (two : IZR (2 * scale S) = m * 2) by (rewrite mult_IZR; unfold m; ring).
  assert (minus : IZR (- (2 * scale S)) = m * -2) by (rewrite opp_IZR, two; ring).
  assert (identity : ((zB (entries S) =? 0) && (zC (entries S) =? 0))%Z = true <-> mB M = 0 /\ mC M = 0).
  { rewrite andb_true_iff, !Z.eqb_eq; split; intros [b c]; split.
    - rewrite b in B; nra.
    - rewrite c in E; nra.
    - apply eq_IZR; rewrite B, b; ring.
    - apply eq_IZR; rewrite E, c; ring. }
  assert (scaled_eq : forall x y, m * x = m * y -> x = y) by (intros x y X; apply (Rmult_eq_reg_l m); lra).
  assert (scaled_lt : forall x y, m * x < m * y -> x < y) by (intros x y X; apply (Rmult_lt_reg_l m); lra).
  destruct (Z.compare_spec (zA (entries S) + zD (entries S)) (2 * scale S)) as [F|F|F].
  - apply (f_equal IZR) in F; rewrite T, two in F; apply scaled_eq in F.
    destruct (_ && _)%bool.
    + destruct identity as [I _]; destruct (I eq_refl) as [b c]; clear I.
      assert (M = one) as ->; [|split; [reflexivity | exact bounded_one]].
      destruct M; unfold det, tr, one in *; simpl in *; rewrite b, c in *; f_equal; nra.
    + split; [exact F|]; apply parabolic; [exact one_det | rewrite F; apply Rabs_right; lra | |].
      * intros I; destruct identity as [_ J]; enough (false = true) by discriminate; apply J.
        rewrite I; split; reflexivity.
      * intros I; rewrite I in F; unfold tr, opp, one in F; simpl in F; lra.
  - apply IZR_lt in F; rewrite T, two in F; apply scaled_lt in F.
    destruct (Z.compare_spec (zA (entries S) + zD (entries S)) (- (2 * scale S))) as [G|G|G].
    + apply (f_equal IZR) in G; rewrite T, minus in G; apply scaled_eq in G.
      destruct (_ && _)%bool.
      * destruct identity as [I _]; destruct (I eq_refl) as [b c]; clear I.
        assert (M = opp one) as ->; [|split; [reflexivity | apply bounded_opp; exact bounded_one]].
        destruct M; unfold det, tr, opp, one in *; simpl in *; rewrite b, c in *; f_equal; nra.
      * split; [exact G|]; apply parabolic; [exact one_det | rewrite G, Rabs_left; lra | |].
        -- intros I; rewrite I in G; unfold tr, one in G; simpl in G; lra.
        -- intros I; destruct identity as [_ J]; enough (false = true) by discriminate; apply J.
           rewrite I; simpl; split; ring.
    + apply IZR_lt in G; rewrite T, minus in G; apply scaled_lt in G.
      split; [exact G|]; apply hyperbolic; [exact one_det | rewrite Rabs_left; lra].
    + apply IZR_lt in G; rewrite T, minus in G; apply scaled_lt in G.
      split; [lra|]; apply elliptic; [exact one_det | lra].
  - apply IZR_lt in F; rewrite T, two in F; apply scaled_lt in F.
    split; [exact F|]; apply hyperbolic; [exact one_det | rewrite Rabs_right; lra].
Qed.

Theorem word_certificate k letters h L1 L2 x l1 l2 :
  x = Q2R h -> l1 = Q2R L1 -> l2 = Q2R L2 ->
  check k letters h L1 L2 = true ->
  word_verdict k letters x l1 l2.
Proof.
  intros -> -> -> H; unfold check in H; cbv zeta in H.
  rewrite !andb_true_iff in H; destruct H as (((P & S) & m) & E).
  apply Z.ltb_lt in P; apply Z.ltb_lt, IZR_lt in m.
  assert (positive : 0 < Q2R h).
  { unfold Q2R; apply Rmult_lt_0_compat; [now apply IZR_lt|]; apply Rinv_0_lt_compat, IZR_lt; reflexivity. }
  assert (all : solvable (Q2R h) (Q2R L1) (Q2R L2) letters).
  { unfold solvable; apply Forall_forall; intros l In; apply real_solvable.
    rewrite forallb_forall in S; exact (S l In). }
  split; [exact positive | exact all |].
  apply same_kind_eq in E; subst k.
  apply classify_trace_sound; [exact m | apply run_spec; assumption | apply det_word; assumption].
Qed.

(** [certify_word h L1 L2]: the rationals as elements of Q, denominators positive. *)
Ltac certify_word h L1 L2 :=
  apply (word_certificate _ _ h%Q L1%Q L2%Q);
  [ cbv [Q2R Qnum Qden]; lra .. | vm_cast_no_check (eq_refl true) ].
