(** * Verdicts on input with pi, proven by computation

    Steps and stiffnesses are rational multiples of powers of pi. Pi is enclosed by Machin's series
    pi/4 = 2 atan(1/3) + atan(1/7), the half period's matrix by intervals with integer ends over one power of two; where the
    four signs come out definite, they decide. So only the open kinds can be proven: elliptic and hyperbolic.

    Kick by kick an interval loses a bit or two at every kick, whatever the orbit does. So only a few kicks are made one by
    one; such blocks are multiplied in pairs, these in pairs, and so on: then the loss grows with the logarithm of their
    number, and 128 bits do for thousands of kicks.

    - [pi_bounds]       integers about w pi;
    - [check_pi]        the computation, a boolean;
    - [certificate_pi]  check_pi = true proves the verdict about the real full-period propagator;
    - [certify_pi]      the tactic that generated files use: one vm_compute.                          *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks SignTable Certificate.
From Coq Require Import Reals Qreals QArith ZArith List Arith Bool Lia Lra Psatz Machin Ratan.
Import ListNotations.

(** ** The computation *)

Open Scope Z_scope.

(** The interval [lo/w, hi/w]. *)
Record iv := Iv { lo : Z; hi : Z }.

Definition up (n d : Z) := - (- n / d).
(** x / w for a power of two: its bits are dropped, which takes no division. *)
Definition down (w x : Z) := Z.shiftr x (Z.log2 w).
Definition iadd (a b : iv) := Iv (lo a + lo b) (hi a + hi b).
Definition isub (a b : iv) := Iv (lo a - hi b) (hi a - lo b).
Definition iscale (t : Z) (a : iv) := Iv (t * lo a) (t * hi a).
Definition imul (w : Z) (a b : iv) :=
  let x := lo a * lo b in let y := lo a * hi b in let z := hi a * lo b in let u := hi a * hi b in
  Iv (down w (Z.min (Z.min x y) (Z.min z u))) (- down w (- Z.max (Z.max x y) (Z.max z u))).
Definition iinv (w : Z) (a : iv) := Iv (w * w / hi a) (up (w * w) (lo a)).
Definition iratio (w : Z) (c : Q) := Iv (Qnum c * w / QDen c) (up (Qnum c * w) (QDen c)).
Fixpoint ipow (w : Z) (a : iv) (n : nat) := match n with O => Iv w w | S n' => imul w a (ipow w a n') end.
Definition isign (a : iv) := if 0 <? lo a then 1 else if hi a <? 0 then -1 else 0.

(** w times the n-th term of 2 atan(1/3) + atan(1/7), less than 2 too small; the alternating sums. *)
Definition term (w : Z) (n : nat) :=
  let k := 2 * Z.of_nat n + 1 in 2 * w / (3 ^ k * k) + w / (7 ^ k * k).
Fixpoint partial (w : Z) (n : nat) : iv :=
  let t := term w n in
  let own := if Nat.even n then Iv t (t + 2) else Iv (- t - 2) (- t) in
  match n with O => own | S n' => iadd (partial w n') own end.
Definition pi_bounds (w : Z) (n : nat) := Iv (4 * lo (partial w (S (2 * n)))) (4 * hi (partial w (2 * n))).

Record imat := IMat { iA : iv; iB : iv; iC : iv; iD : iv }.
Definition idrift (t : Z) (M : imat) := IMat (iadd (iA M) (iscale t (iC M))) (iadd (iB M) (iscale t (iD M))) (iC M) (iD M).
Definition ikick (w : Z) (n : iv) (M : imat) :=
  IMat (iA M) (iB M) (isub (iC M) (imul w n (iA M))) (isub (iD M) (imul w n (iB M))).
Definition ihalf (p q : Z) (n1 n2 : iv) (j : Z) :=
  iadd (if j mod (2 * q) =? 0 then n1 else Iv 0 0) (if j mod (2 * p) =? 0 then n2 else Iv 0 0).

(** Products of blocks: the last block, its kicks, and before it products of 1, 2, 4, ... blocks, where there are such. *)
Definition imat_mul (w : Z) (M N : imat) :=
  IMat (iadd (imul w (iA M) (iA N)) (imul w (iB M) (iC N))) (iadd (imul w (iA M) (iB N)) (imul w (iB M) (iD N)))
       (iadd (imul w (iC M) (iA N)) (imul w (iD M) (iC N))) (iadd (imul w (iC M) (iB N)) (imul w (iD M) (iD N))).
Fixpoint push (w : Z) (M : imat) (stack : list (option imat)) :=
  match stack with
  | [] => [Some M]
  | None :: rest => Some M :: rest
  | Some N :: rest => None :: push w (imat_mul w M N) rest
  end.
Fixpoint collect (w : Z) (M : imat) (stack : list (option imat)) :=
  match stack with
  | [] => M
  | None :: rest => collect w M rest
  | Some N :: rest => collect w (imat_mul w M N) rest
  end.

Record blocks := Blocks { block : imat; kicks : nat; earlier : list (option imat) }.
Definition ione (w : Z) := IMat (Iv w w) (Iv 0 0) (Iv 0 0) (Iv w w).
Definition bdrift (t : Z) (X : blocks) := Blocks (idrift t (block X)) (kicks X) (earlier X).
Definition bkick (w : Z) (n : iv) (X : blocks) :=
  let M := ikick w n (block X) in
  match kicks X with
  | O => Blocks (ione w) 7 (push w M (earlier X))
  | S more => Blocks M more (earlier X)
  end.

Definition open_kind (M : imat) (k : kind) : bool :=
  match k with
  | Elliptic => (isign (iB M) * isign (iC M) =? -1) && (isign (iA M) * isign (iD M) =? 1)
  | Hyperbolic Plus => isign (iB M) * isign (iC M) =? 1
  | Hyperbolic Minus => isign (iA M) * isign (iD M) =? -1
  | _ => false
  end.

(** Numbers c pi^e, as (c, e): half a kick in ticks, h^2 L / (4c). *)
Definition ipower (w : Z) (pi : iv) (e : Z) :=
  match e with Z0 => Iv w w | Zpos n => ipow w pi (Pos.to_nat n) | Zneg n => ipow w (iinv w pi) (Pos.to_nat n) end.
Definition strength (w : Z) (pi : iv) (h L : Q * Z) (c : Z) :=
  imul w (iratio w (Qred (fst h * fst h * fst L / (4 * inject_Z c))%Q)) (ipower w pi (2 * snd h + snd L)).

Definition check_pi (bits : Z) (k : kind) (p q : nat) (h1 L1 h2 L2 : Q * Z) : bool :=
  let w := 2 ^ bits in
  let zp := Z.of_nat p in
  let zq := Z.of_nat q in
  let pi := pi_bounds w (Z.to_nat (bits / 6 + 2)) in
  let n1 := strength w pi h1 L1 zq in
  let n2 := strength w pi h2 L2 zp in
  (1 <=? p)%nat && (1 <=? q)%nat && (Nat.gcd p q =? 1)%nat &&
  (0 <? Qnum (fst h1)) && (0 <? Qnum (fst h2)) && (snd h1 =? snd h2) &&
  Qeq_bool (inject_Z zp * fst h1) (inject_Z zq * fst h2) && (0 <? w) && (0 <? lo pi) &&
  match run zp zq bdrift (fun j => bkick w (ihalf zp zq n1 n2 j)) (fun j => bkick w (iscale 2 (ihalf zp zq n1 n2 j)))
          (p + q) 0 (bkick w (iadd n1 n2) (Blocks (ione w) 7 [])) with
  | Some X => open_kind (collect w (block X) (earlier X)) k
  | None => false
  end.

(** The first precision that suffices. *)
Fixpoint search (bits : list Z) (check : Z -> bool) : bool :=
  match bits with [] => false | b :: more => if check b then true else search more check end.

(** ** Its meaning *)

Open Scope R_scope.

Definition encloses (w : Z) (a : iv) (x : R) := IZR (lo a) <= IZR w * x <= IZR (hi a).

Lemma down_le n d : (0 < d)%Z -> IZR (n / d) <= IZR n / IZR d.
Proof.
  intros D; assert (0 < IZR d) by now apply IZR_lt.
  apply Rmult_le_reg_r with (IZR d); [assumption|]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  rewrite <- mult_IZR; apply IZR_le; rewrite Z.mul_comm; now apply Z.mul_div_le.
Qed.

Lemma up_ge n d : (0 < d)%Z -> IZR n / IZR d <= IZR (up n d).
Proof.
  intros D; pose proof (down_le (- n) d D) as B; unfold up; rewrite opp_IZR in B |- *; unfold Rdiv in *; lra.
Qed.

Lemma product_above a b c d x y l : a <= x <= b -> c <= y <= d ->
  l <= a * c -> l <= a * d -> l <= b * c -> l <= b * d -> l <= x * y.
Proof.
  intros X Y; intros.
  assert (l <= a * y) by (destruct (Rle_dec 0 a); nra).
  assert (l <= b * y) by (destruct (Rle_dec 0 b); nra).
  destruct (Rle_dec 0 y); nra.
Qed.

Section Intervals.
Variable w : Z.
Hypothesis w_pos : (0 < w)%Z.
Hypothesis w_power : w = (2 ^ Z.log2 w)%Z.
Let W : 0 < IZR w.
Proof. now apply IZR_lt. Qed.

Lemma enclose_zero : encloses w (Iv 0 0) 0.
Proof. unfold encloses; simpl; lra. Qed.

Lemma enclose_one : encloses w (Iv w w) 1.
Proof. unfold encloses; simpl; lra. Qed.

Lemma enclose_add a b x y : encloses w a x -> encloses w b y -> encloses w (iadd a b) (x + y).
Proof. unfold encloses; simpl; rewrite !plus_IZR; lra. Qed.

Lemma enclose_sub a b x y : encloses w a x -> encloses w b y -> encloses w (isub a b) (x - y).
Proof. unfold encloses; simpl; rewrite !minus_IZR; lra. Qed.

Lemma enclose_scale t a x : (0 <= t)%Z -> encloses w a x -> encloses w (iscale t a) (IZR t * x).
Proof. intros T; apply IZR_le in T; unfold encloses; simpl; rewrite !mult_IZR; nra. Qed.

Lemma down_div x : down w x = (x / w)%Z.
Proof. unfold down; rewrite Z.shiftr_div_pow2 by apply Z.log2_nonneg; now rewrite <- w_power. Qed.

Lemma enclose_mul a b x y : encloses w a x -> encloses w b y -> encloses w (imul w a b) (x * y).
Proof.
  intros A B; unfold imul; rewrite !down_div.
  set (p1 := (lo a * lo b)%Z); set (p2 := (lo a * hi b)%Z); set (p3 := (hi a * lo b)%Z); set (p4 := (hi a * hi b)%Z).
  set (l := Z.min (Z.min p1 p2) (Z.min p3 p4)); set (u := Z.max (Z.max p1 p2) (Z.max p3 p4)).
  assert (Product : IZR l <= IZR w * x * (IZR w * y) <= IZR u).
  { split.
    - apply (product_above _ _ _ _ _ _ _ A B); rewrite <- mult_IZR; apply IZR_le; unfold l, p1, p2, p3, p4; lia.
    - apply Ropp_le_cancel; rewrite <- Ropp_mult_distr_l_reverse.
      apply (product_above (- IZR (hi a)) (- IZR (lo a)) (IZR (lo b)) (IZR (hi b))); unfold encloses in A, B; try lra;
        rewrite Ropp_mult_distr_l_reverse; apply Ropp_le_contravar; rewrite <- mult_IZR; apply IZR_le;
        unfold u, p1, p2, p3, p4; lia. }
  assert (E : IZR w * (x * y) = IZR w * x * (IZR w * y) / IZR w) by (field; lra).
  fold l u; change (- (- u / w))%Z with (up u w); unfold encloses; cbv [lo hi]; rewrite E; split.
  - apply Rle_trans with (1 := down_le l w w_pos); apply Rmult_le_compat_r; [left; now apply Rinv_0_lt_compat | lra].
  - apply Rle_trans with (2 := up_ge u w w_pos); apply Rmult_le_compat_r; [left; now apply Rinv_0_lt_compat | lra].
Qed.

Lemma enclose_inv a x : (0 < lo a)%Z -> encloses w a x -> encloses w (iinv w a) (/ x).
Proof.
  intros L [A B]; assert (L' : 0 < IZR (lo a)) by now apply IZR_lt.
  assert (X : 0 < x) by nra.
  assert (E : IZR w * / x = IZR (w * w) / (IZR w * x)) by (rewrite mult_IZR; field; lra).
  assert (S : 0 < IZR (w * w)) by (rewrite mult_IZR; nra).
  assert (H : (0 < hi a)%Z) by (apply lt_IZR; lra).
  unfold encloses, iinv; simpl; rewrite E; split.
  - apply Rle_trans with (1 := down_le _ _ H); apply Rmult_le_compat_l; [lra | apply Rinv_le_contravar; nra].
  - apply Rle_trans with (2 := up_ge _ _ L); apply Rmult_le_compat_l; [lra | now apply Rinv_le_contravar].
Qed.

Lemma enclose_ratio c : encloses w (iratio w c) (Q2R c).
Proof.
  assert (E : IZR w * Q2R c = IZR (Qnum c * w) / IZR (QDen c)) by (unfold Q2R; rewrite mult_IZR; field; apply IZR_neq; lia).
  unfold encloses, iratio; cbv [lo hi]; rewrite E; split; [apply down_le | apply up_ge]; lia.
Qed.

Lemma enclose_pow a x n : encloses w a x -> encloses w (ipow w a n) (x ^ n).
Proof. intros A; induction n as [|n IH]; simpl; [apply enclose_one | now apply enclose_mul]. Qed.

Lemma isign_spec a x : encloses w a x -> (isign a = 1%Z -> 0 < x) /\ (isign a = (-1)%Z -> x < 0).
Proof.
  intros [A B]; unfold isign; destruct (Z.ltb_spec 0 (lo a)) as [L|L]; [|destruct (Z.ltb_spec (hi a) 0) as [H|H]].
  - apply IZR_lt in L; split; [nra | discriminate].
  - apply IZR_lt in H; split; [discriminate | nra].
  - split; discriminate.
Qed.

(** ** Pi *)

Lemma fraction_bounds n d : (0 < d)%Z -> IZR (n / d) <= IZR n / IZR d < IZR (n / d) + 1.
Proof.
  intros D; split; [now apply down_le|].
  assert (0 < IZR d) by now apply IZR_lt.
  apply Rmult_lt_reg_r with (IZR d); [assumption|]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  rewrite <- (plus_IZR _ 1), <- mult_IZR; apply IZR_lt; rewrite Z.mul_comm, <- Z.add_1_r || rewrite Z.mul_comm.
  now apply Z.mul_succ_div_gt.
Qed.

Lemma term_bounds n : IZR (term w n) <= IZR w * PI_2_3_7_tg n <= IZR (term w n) + 2.
Proof.
  unfold term, PI_2_3_7_tg, Ratan_seq; set (k := (2 * Z.of_nat n + 1)%Z).
  assert (K : IZR k = INR (2 * n + 1)) by (rewrite INR_IZR_INZ; f_equal; unfold k; lia).
  assert (K0 : 0 < IZR k) by (apply IZR_lt; unfold k; lia).
  assert (P : forall b, IZR (b ^ k) = IZR b ^ (2 * n + 1)).
  { intros b; rewrite pow_IZR; f_equal; f_equal; unfold k; lia. }
  assert (Positive : forall b, (0 < b)%Z -> (0 < b ^ k * k)%Z).
  { intros b B; apply Z.mul_pos_pos; [apply Z.pow_pos_nonneg|]; unfold k; lia. }
  pose proof (fraction_bounds (2 * w) (3 ^ k * k) (Positive 3%Z ltac:(lia))) as T.
  pose proof (fraction_bounds w (7 ^ k * k) (Positive 7%Z ltac:(lia))) as U.
  assert (N3 : 3 ^ (2 * n + 1) <> 0) by (apply pow_nonzero; lra).
  assert (N7 : 7 ^ (2 * n + 1) <> 0) by (apply pow_nonzero; lra).
  rewrite !mult_IZR, P, K in T; rewrite !mult_IZR, P, K in U; rewrite K in K0.
  rewrite plus_IZR, !pow_inv.
  replace (IZR w * (2 * (/ 3 ^ (2 * n + 1) / INR (2 * n + 1)) + / 7 ^ (2 * n + 1) / INR (2 * n + 1)))
    with (2 * IZR w / (3 ^ (2 * n + 1) * INR (2 * n + 1)) + IZR w / (7 ^ (2 * n + 1) * INR (2 * n + 1)))
    by (field; repeat split; assumption || lra).
  lra.
Qed.

Lemma partial_bounds n : encloses w (partial w n) (sum_f_R0 (tg_alt PI_2_3_7_tg) n).
Proof.
  assert (Own : forall n, encloses w (if Nat.even n then Iv (term w n) (term w n + 2) else Iv (- term w n - 2) (- term w n))
                                     (tg_alt PI_2_3_7_tg n)).
  { intros i; pose proof (term_bounds i) as T; unfold tg_alt, encloses.
    assert (Sign : (-1) ^ i = if Nat.even i then 1 else -1).
    { clear; induction i as [|i IH]; [reflexivity|].
      rewrite Nat.even_succ, <- Nat.negb_even; simpl; rewrite IH; destruct (Nat.even i); simpl; ring. }
    rewrite Sign; set (x := PI_2_3_7_tg i) in *; clearbody x; destruct (Nat.even i); cbv [lo hi];
      rewrite ?plus_IZR, ?minus_IZR, ?opp_IZR; lra. }
  induction n as [|n IH]; [apply (Own O)|]; exact (enclose_add _ _ _ _ IH (Own (S n))).
Qed.

Lemma enclose_pi n : encloses w (pi_bounds w n) PI.
Proof.
  pose proof (PI_2_3_7_ineq n) as B; pose proof (partial_bounds (S (2 * n))) as L; pose proof (partial_bounds (2 * n)) as U.
  unfold encloses, pi_bounds in *; cbv [lo hi] in *; rewrite !mult_IZR; nra.
Qed.

(** ** The half period *)

Definition encloses_matrix (Z : imat) (M : mat) :=
  encloses w (iA Z) (mA M) /\ encloses w (iB Z) (mB M) /\ encloses w (iC Z) (mC M) /\ encloses w (iD Z) (mD M).

Lemma enclose_drift t Z M : (0 <= t)%Z -> encloses_matrix Z M -> encloses_matrix (idrift t Z) (drift (IZR t) ** M).
Proof.
  intros T (A & B & C & D); unfold encloses_matrix, mul, drift, idrift; cbn [iA iB iC iD mA mB mC mD].
  rewrite !Rmult_1_l, !Rmult_0_l, !Rplus_0_l; auto 6 using enclose_add, enclose_scale.
Qed.

Lemma enclose_kick n k Z M : encloses w n k -> encloses_matrix Z M -> encloses_matrix (ikick w n Z) (kick k ** M).
Proof.
  intros K (A & B & C & D); unfold encloses_matrix, mul, kick, ikick; cbn [iA iB iC iD mA mB mC mD].
  replace (- k * mA M + 1 * mC M) with (mC M - k * mA M) by ring.
  replace (- k * mB M + 1 * mD M) with (mD M - k * mB M) by ring.
  rewrite !Rmult_1_l, !Rmult_0_l, !Rplus_0_r; auto 7 using enclose_sub, enclose_mul.
Qed.

Lemma enclose_one_matrix : encloses_matrix (ione w) one.
Proof. repeat split; simpl; try apply enclose_one; apply enclose_zero. Qed.

Lemma enclose_product Y Z M N : encloses_matrix Y M -> encloses_matrix Z N -> encloses_matrix (imat_mul w Y Z) (M ** N).
Proof.
  intros (A & B & C & D) (A' & B' & C' & D'); unfold encloses_matrix, mul, imat_mul; cbn [iA iB iC iD mA mB mC mD].
  auto 8 using enclose_add, enclose_mul.
Qed.

(** The product of a stack, the latest factor first. *)
Fixpoint stacked (stack : list (option imat)) (M : mat) : Prop :=
  match stack with
  | [] => M = one
  | None :: rest => stacked rest M
  | Some Z :: rest => exists L N, encloses_matrix Z L /\ stacked rest N /\ M = L ** N
  end.

Lemma push_sound stack : forall Z L N, encloses_matrix Z L -> stacked stack N -> stacked (push w Z stack) (L ** N).
Proof.
  induction stack as [|[Y|] rest IH]; intros Z L N E S; simpl in S |- *.
  - exists L, one; subst N; auto.
  - destruct S as (K & P & F & R & ->); rewrite mul_assoc; apply IH; [now apply enclose_product | assumption].
  - now exists L, N.
Qed.

Lemma collect_sound stack : forall Z L N, encloses_matrix Z L -> stacked stack N -> encloses_matrix (collect w Z stack) (L ** N).
Proof.
  induction stack as [|[Y|] rest IH]; intros Z L N E S; simpl in S |- *.
  - subst N; now rewrite mul_one_r.
  - destruct S as (K & P & F & R & ->); rewrite mul_assoc; apply IH; [now apply enclose_product | assumption].
  - now apply IH.
Qed.

Definition multiplied (X : blocks) (M : mat) :=
  exists L N, encloses_matrix (block X) L /\ stacked (earlier X) N /\ M = L ** N.

Lemma multiplied_drift t X M : (0 <= t)%Z -> multiplied X M -> multiplied (bdrift t X) (drift (IZR t) ** M).
Proof.
  intros T (L & N & E & R & ->); exists (drift (IZR t) ** L), N.
  split; [now apply enclose_drift | split; [assumption | apply mul_assoc]].
Qed.

Lemma multiplied_kick n k X M : encloses w n k -> multiplied X M -> multiplied (bkick w n X) (kick k ** M).
Proof.
  intros K (L & N & E & R & ->); pose proof (enclose_kick _ _ _ _ K E) as F; unfold bkick.
  destruct (kicks X); rewrite mul_assoc.
  - exists one, (kick k ** L ** N); split; [apply enclose_one_matrix | split; [now apply push_sound | now rewrite mul_one_l]].
  - now exists (kick k ** L), N.
Qed.

Lemma open_kind_sound k Z M : encloses_matrix Z M -> open_kind Z k = true -> row k M.
Proof.
  intros (A & B & C & D).
  assert (S : forall a, (isign a = 1 \/ isign a = -1 \/ isign a = 0)%Z).
  { intros a; unfold isign; destruct (0 <? lo a)%Z; [auto|]; destruct (hi a <? 0)%Z; auto. }
  apply isign_spec in A, B, C, D; destruct A as [Ap An], B as [Bp Bn], C as [Cp Cn], D as [Dp Dn].
  destruct k as [|[]|[]|[]]; simpl; try discriminate; rewrite ?Bool.andb_true_iff, ?Z.eqb_eq; intros E;
    destruct (S (iA Z)) as [a|[a|a]], (S (iD Z)) as [d|[d|d]], (S (iB Z)) as [b|[b|b]], (S (iC Z)) as [c|[c|c]];
    rewrite ?a, ?b, ?c, ?d in E; try lia;
    repeat match goal with
      | H : isign ?x = 1%Z -> 0 < ?y, G : isign ?x = 1%Z |- _ => specialize (H G)
      | H : isign ?x = (-1)%Z -> ?y < 0, G : isign ?x = (-1)%Z |- _ => specialize (H G)
    end; nra.
Qed.
End Intervals.

(** c pi^e *)
Definition times_pi (x : Q * Z) : R := Q2R (fst x) * powerRZ PI (snd x).

Theorem certificate_pi bits k p q h1 L1 h2 L2 x1 l1 x2 l2 :
  x1 = times_pi h1 -> l1 = times_pi L1 -> x2 = times_pi h2 -> l2 = times_pi L2 ->
  search bits (fun b => check_pi b k p q h1 L1 h2 L2) = true ->
  verdict k p q x1 l1 x2 l2.
Proof.
  intros -> -> -> -> S; induction bits as [|bits more IH]; [discriminate|]; simpl in S.
  destruct (check_pi bits k p q h1 L1 h2 L2) eqn:C; [clear IH S more | auto].
  unfold check_pi in C; cbv zeta in C.
  set (w := (2 ^ bits)%Z) in C; set (pi := pi_bounds w _) in C.
  set (n1 := strength w pi h1 L1 _) in C; set (n2 := strength w pi h2 L2 _) in C.
  repeat rewrite Bool.andb_true_iff in C.
  destruct C as (((((((((Pp & Pq) & G) & H1) & H2) & E) & T) & Wp) & Pip) & K).
  apply Nat.leb_le in Pp, Pq; apply Nat.eqb_eq in G; apply Z.ltb_lt in H1, H2, Wp, Pip; apply Z.eqb_eq in E.
  apply Qeq_bool_eq, Qeq_eqR in T; rewrite !Q2R_mult, !Q2R_inject, <- !INR_IZR_INZ in T.
  pose proof PI_RGT_0 as Pi0.
  assert (W2 : w = (2 ^ Z.log2 w)%Z).
  { unfold w in *; destruct (Z.le_gt_cases 0 bits); [now rewrite Z.log2_pow2 | now rewrite Z.pow_neg_r in Wp]. }
  assert (Power : forall e, encloses w (ipower w pi e) (powerRZ PI e)).
  { intros [|n|n]; simpl; [now apply enclose_one | now apply enclose_pow, enclose_pi |].
    rewrite <- pow_inv; apply enclose_pow, enclose_inv; auto; now apply enclose_pi. }
  assert (Pow0 : forall e, 0 < powerRZ PI e) by (intros e; now apply powerRZ_lt).
  assert (Qpos : forall h, (0 < Qnum h)%Z -> 0 < Q2R h).
  { intros h P; unfold Q2R; apply Rmult_lt_0_compat; [now apply IZR_lt|]; apply Rinv_0_lt_compat, IZR_lt; lia. }
  assert (Hp : forall h, (0 < Qnum (fst h))%Z -> 0 < times_pi h) by (intros; apply Rmult_lt_0_compat; auto).
  assert (Ip : 0 < INR p) by (apply lt_0_INR; lia); assert (Iq : 0 < INR q) by (apply lt_0_INR; lia).
  assert (Half : forall h L c, (1 <= c)%nat ->
     encloses w (strength w pi h L (Z.of_nat c)) (times_pi h * times_pi L * tick c (times_pi h) / 2)).
  { intros h L c Cp; assert (0 < INR c) by (apply lt_0_INR; lia).
    replace (times_pi h * times_pi L * tick c (times_pi h) / 2)
      with (Q2R (Qred (fst h * fst h * fst L / (4 * inject_Z (Z.of_nat c)))) * powerRZ PI (2 * snd h + snd L)).
    - apply enclose_mul; auto; now apply enclose_ratio.
    - rewrite (Qeq_eqR _ _ (Qred_correct _)); unfold Qdiv, times_pi, tick.
      replace (2 * snd h + snd L)%Z with (snd h + snd h + snd L)%Z by lia; rewrite !powerRZ_add by lra.
      rewrite Q2R_mult, Q2R_inv, !Q2R_mult, Q2R_inject, <- INR_IZR_INZ.
      + replace (Q2R 4) with 4 by (unfold Q2R; simpl; field); field; lra.
      + intros Z; apply (Qeq_eqR _ 0%Q) in Z; rewrite Q2R_mult, Q2R_inject, <- INR_IZR_INZ in Z.
        unfold Q2R in Z; simpl in Z; lra. }
  pose proof (Half h1 L1 q Pq) as N1; pose proof (Half h2 L2 p Pp) as N2; fold n1 in N1; fold n2 in N2.
  assert (Steps : INR p * times_pi h1 = INR q * times_pi h2) by (unfold times_pi; rewrite <- !Rmult_assoc, T, E; reflexivity).
  clearbody n1 n2; clear Half Power.
  clearbody w.
  apply verdict_in_ticks; auto.
  set (k1 := times_pi h1 * _ * _) in *; set (k2 := times_pi h2 * _ * _) in *; clearbody k1 k2.
  destruct (run _ _ _ _ _ _ _ _) as [X|] eqn:R; [|discriminate].
  apply (open_kind_sound w Wp _ (collect w (block X) (earlier X))); [|assumption].
  assert (Each : forall j, encloses w (ihalf (Z.of_nat p) (Z.of_nat q) n1 n2 (Z.of_nat j)) (two_clocks p q false false k1 k2 j / 2)).
  { intros j; unfold ihalf, two_clocks; rewrite <- !strikes_Z by assumption.
    replace (_ / 2) with ((if strikes q false j then k1 / 2 else 0) + (if strikes p false j then k2 / 2 else 0))
      by (destruct (strikes q false j), (strikes p false j); field).
    apply enclose_add; [destruct (strikes q false j) | destruct (strikes p false j)]; auto; apply enclose_zero. }
  enough (Product : multiplied w X (propagator (schedule (two_clocks p q false false k1 k2) 1 (p * q)))).
  { destruct Product as (L & N & F & T' & ->); now apply collect_sound. }
  refine (run_sound p q k1 k2 Pp Pq _ _ _ (multiplied w) (multiplied_drift w) _ _ (p + q) 0 _ X _ _ R).
  - intros j Z N B; now apply multiplied_kick.
  - intros j Z N B; apply multiplied_kick; auto.
    replace (two_clocks p q false false k1 k2 j) with (2 * (two_clocks p q false false k1 k2 j / 2)) by field.
    apply enclose_scale; auto; lia.
  - nia.
  - change (Z.of_nat 0) with 0%Z.
    replace (kick _ ** propagator (schedule _ 1 0)) with (kick (k1 / 2 + k2 / 2) ** one).
    + apply multiplied_kick; auto; [now apply enclose_add|].
      exists one, one; simpl; rewrite mul_one_l; auto using enclose_one_matrix.
    + f_equal; f_equal; unfold two_clocks, strikes; rewrite !Nat.mod_0_l by lia; simpl; field.
Qed.

(** [certify_pi h1 L1 h2 L2]: the numbers (c, e) for c pi^e; bits double until they suffice. *)
Ltac certify_pi h1 L1 h2 L2 :=
  apply (certificate_pi [128; 256; 512]%Z _ _ _ h1 L1 h2 L2);
  [ cbv [times_pi fst snd Q2R Qnum Qden]; f_equal; lra .. | vm_cast_no_check (eq_refl true) ].
