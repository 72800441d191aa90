(** * Verdicts on rational input, proven by computation

    In the unit "tick" every drift is an integer, and a half kick has the rational strength n_i / m with
    one denominator m. So a positive multiple of the half period's matrix is computed over Z: a drift adds,
    a kick multiplies by m; only ticks that strike are visited. The four signs decide.

    - [check k p q h1 L1 h2 L2]  the computation (inputs in Q), a boolean;
    - [certificate]              check = true proves the verdict about the real full-period propagator;
    - [certify]                  the tactic that generated files use: one vm_compute.                  *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks SignTable.
From Coq Require Import Reals Qreals QArith ZArith List Arith Bool Lia Lra Psatz.

(** ** The computation *)

Open Scope Z_scope.

Record zmat := ZMat { zA : Z; zB : Z; zC : Z; zD : Z }.

Definition zdrift (t : Z) (M : zmat) := ZMat (zA M + t * zC M) (zB M + t * zD M) (zC M) (zD M).
Definition zkick (m n : Z) (M : zmat) :=
  ZMat (m * zA M) (m * zB M) (m * zC M - n * zA M) (m * zD M - n * zB M).

(** The clocks strike every 2q and every 2p ticks; half a kick is n1/m, n2/m. *)
Definition half_kick (p q n1 n2 j : Z) :=
  (if j mod (2 * q) =? 0 then n1 else 0) + (if j mod (2 * p) =? 0 then n2 else 0).

Definition next_strike (p q t : Z) := Z.min (2 * q * (t / (2 * q) + 1)) (2 * p * (t / (2 * p) + 1)).

(** From just after the kick at tick t to the half kick at tick pq, on states of any kind. *)
Fixpoint run {state : Type} (p q : Z) (glide half whole : Z -> state -> state) (fuel : nat) (t : Z) (M : state)
  : option state :=
  match fuel with
  | O => None
  | S fuel' =>
      let j := next_strike p q t in
      if j <? p * q
      then run p q glide half whole fuel' j (whole j (glide (j - t) M))
      else Some (half (p * q) (glide (p * q - t) M))
  end.

Definition zrun (p q m n1 n2 : Z) (fuel : nat) : option zmat :=
  run p q zdrift (fun j => zkick m (half_kick p q n1 n2 j)) (fun j => zkick m (2 * half_kick p q n1 n2 j)) fuel 0
    (zkick m (n1 + n2) (ZMat 1 0 0 1)).

Definition classify (M : zmat) : kind :=
  match Z.sgn (zB M) * Z.sgn (zC M) with
  | Zpos _ => Hyperbolic Plus
  | Z0 => if (zB M =? 0) && (zC M =? 0) then Coexistence Plus else Parabolic Plus
  | Zneg _ =>
      match Z.sgn (zA M) * Z.sgn (zD M) with
      | Zpos _ => Elliptic
      | Z0 => if (zA M =? 0) && (zD M =? 0) then Coexistence Minus else Parabolic Minus
      | Zneg _ => Hyperbolic Minus
      end
  end.

Definition same_kind (k l : kind) : bool :=
  match k, l with
  | Elliptic, Elliptic => true
  | Hyperbolic s, Hyperbolic t | Parabolic s, Parabolic t | Coexistence s, Coexistence t =>
      match s, t with Plus, Plus | Minus, Minus => true | _, _ => false end
  | _, _ => false
  end.

(** Half kicks in ticks, h_i^2 L_i / (4q) and / (4p), brought to one denominator. *)
Definition check (k : kind) (p q : nat) (h1 L1 h2 L2 : Q) : bool :=
  let zp := Z.of_nat p in
  let zq := Z.of_nat q in
  let x1 := Qred (h1 * h1 * L1 / (4 * inject_Z zq))%Q in
  let x2 := Qred (h2 * h2 * L2 / (4 * inject_Z zp))%Q in
  let g := Z.gcd (QDen x1) (QDen x2) in
  let m := Z.to_pos (QDen x1 * (QDen x2 / g)) in
  let n1 := Qnum x1 * (QDen x2 / g) in
  let n2 := Qnum x2 * (QDen x1 / g) in
  (1 <=? p)%nat && (1 <=? q)%nat && (Nat.gcd p q =? 1)%nat &&
  (0 <? Qnum h1) && (0 <? Qnum h2) &&
  Qeq_bool (inject_Z zp * h1) (inject_Z zq * h2) &&
  Qeq_bool (n1 # m) x1 && Qeq_bool (n2 # m) x2 &&
  match zrun zp zq (Zpos m) n1 n2 (p + q) with
  | Some M => same_kind (classify M) k
  | None => false
  end.

(** ** Its meaning *)

Open Scope R_scope.

(** The integers are a positive multiple of the real entries. *)
Definition represents (Z : zmat) (M : mat) :=
  exists c, 0 < c /\ IZR (zA Z) = c * mA M /\ IZR (zB Z) = c * mB M /\ IZR (zC Z) = c * mC M /\ IZR (zD Z) = c * mD M.

Lemma represents_drift t Z M : represents Z M -> represents (zdrift t Z) (drift (IZR t) ** M).
Proof.
  intros (c & C & A & B & E & D); exists c; simpl; rewrite !plus_IZR, !mult_IZR, A, B, E, D.
  split; [exact C|]; repeat split; ring.
Qed.

Lemma represents_kick m n Z M :
  0 < IZR m -> represents Z M -> represents (zkick m n Z) (kick (IZR n / IZR m) ** M).
Proof.
  intros P (c & C & A & B & E & D); exists (IZR m * c); simpl; rewrite !minus_IZR, !mult_IZR, A, B, E, D.
  split; [nra|]; repeat split; field; lra.
Qed.

Lemma propagator_gap f j g :
  (forall i, (j < i < j + S g)%nat -> f i = 0) ->
  propagator (schedule f 1 (j + S g)) =
  kick (f (j + S g)%nat / 2) ** drift (INR (S g)) ** kick (f j / 2) ** propagator (schedule f 1 j).
Proof.
  induction g as [|g IH]; intros Z.
  - rewrite Nat.add_1_r, propagator_schedule_succ; reflexivity.
  - replace (j + S (S g))%nat with (S (j + S g)) by lia.
    rewrite propagator_schedule_succ, IH by (intros; apply Z; lia).
    rewrite (Z (j + S g)%nat) by lia; rewrite (S_INR (S g)).
    generalize (propagator (schedule f 1 j)) (INR (S g)); intros; apply mat_ext; simpl; field.
Qed.

Lemma strikes_Z c j : (1 <= c)%nat -> strikes c false j = (Z.of_nat j mod (2 * Z.of_nat c) =? 0)%Z.
Proof.
  intros C; unfold strikes; rewrite Nat.add_0_r.
  replace (2 * Z.of_nat c)%Z with (Z.of_nat (2 * c)) by lia.
  rewrite <- Nat2Z.inj_mod; apply Bool.eq_iff_eq_true; rewrite Nat.eqb_eq, Z.eqb_eq; lia.
Qed.

(** States of any kind, as long as gliding and kicking do what they mean. *)
Section Run.
Variables (p q : nat) (k1 k2 : R).
Hypotheses (p_pos : (1 <= p)%nat) (q_pos : (1 <= q)%nat).
Let zp := Z.of_nat p.
Let zq := Z.of_nat q.
Let f := two_clocks p q false false k1 k2.

Lemma half_kick_spec m n1 n2 j : k1 / 2 = IZR n1 / IZR m -> k2 / 2 = IZR n2 / IZR m ->
  f j / 2 = IZR (half_kick zp zq n1 n2 (Z.of_nat j)) / IZR m.
Proof.
  intros E1 E2; unfold f, two_clocks, half_kick, zp, zq; rewrite <- !strikes_Z by assumption; rewrite plus_IZR.
  destruct (strikes q false j), (strikes p false j); unfold Rdiv in *; lra.
Qed.

Lemma silent_between j i :
  (j < i)%nat -> (Z.of_nat i < next_strike zp zq (Z.of_nat j))%Z -> f i = 0.
Proof.
  intros J N; unfold f, two_clocks.
  assert (S : forall c, (1 <= c)%nat ->
    (Z.of_nat i < 2 * Z.of_nat c * (Z.of_nat j / (2 * Z.of_nat c) + 1))%Z -> strikes c false i = false).
  { intros c C L; rewrite strikes_Z by assumption; apply Z.eqb_neq; intros E.
    apply Z.mod_divide in E; [|lia]; destruct E as [e E].
    pose proof (Z.mul_div_le (Z.of_nat j) (2 * Z.of_nat c) ltac:(lia)).
    set (d := (Z.of_nat j / (2 * Z.of_nat c))%Z) in *; clearbody d.
    assert (2 * Z.of_nat c * d < e * (2 * Z.of_nat c) < 2 * Z.of_nat c * (d + 1))%Z by lia.
    assert (d < e < d + 1)%Z by nia; lia. }
  unfold next_strike, zp, zq in N; rewrite !S by (assumption || lia); ring.
Qed.

Lemma next_strike_after t : (0 <= t)%Z -> (t < next_strike zp zq t)%Z.
Proof.
  intros T; assert (S : forall c, (0 < c)%Z -> (t < c * (t / c + 1))%Z).
  { intros c C; pose proof (Z.mul_succ_div_gt t c C); lia. }
  unfold next_strike; apply Z.min_glb_lt; apply S; unfold zp, zq; lia.
Qed.

Context {state : Type}.
Variables (glide half whole : Z -> state -> state) (meant : state -> mat -> Prop).
Hypothesis meant_glide : forall t Z M, (0 <= t)%Z -> meant Z M -> meant (glide t Z) (drift (IZR t) ** M).
Hypothesis meant_half : forall j Z M, meant Z M -> meant (half (Z.of_nat j) Z) (kick (f j / 2) ** M).
Hypothesis meant_whole : forall j Z M, meant Z M -> meant (whole (Z.of_nat j) Z) (kick (f j) ** M).

Lemma leap j j' M :
  (j < j')%nat -> (Z.of_nat j' <= next_strike zp zq (Z.of_nat j))%Z ->
  meant M (kick (f j / 2) ** propagator (schedule f 1 j)) ->
  meant (half (Z.of_nat j') (glide (Z.of_nat j' - Z.of_nat j)%Z M)) (propagator (schedule f 1 j')) /\
  meant (whole (Z.of_nat j') (glide (Z.of_nat j' - Z.of_nat j)%Z M)) (kick (f j' / 2) ** propagator (schedule f 1 j')).
Proof.
  intros J N R.
  assert (E : j' = (j + S (j' - j - 1))%nat) by lia.
  assert (P : propagator (schedule f 1 j') =
    kick (f j' / 2) ** (drift (IZR (Z.of_nat j' - Z.of_nat j)) ** (kick (f j / 2) ** propagator (schedule f 1 j)))).
  { rewrite E, propagator_gap, <- E by (intros i I; apply (silent_between j); lia).
    rewrite !mul_assoc; do 3 f_equal; rewrite INR_IZR_INZ; f_equal; f_equal; lia. }
  apply (meant_glide (Z.of_nat j' - Z.of_nat j)) in R; [|lia].
  split.
  - rewrite P; now apply meant_half.
  - rewrite P, mul_assoc, kick_add; replace (f j' / 2 + f j' / 2) with (f j') by field; now apply meant_whole.
Qed.

Lemma run_sound fuel j M M' :
  (j < p * q)%nat ->
  meant M (kick (f j / 2) ** propagator (schedule f 1 j)) ->
  run zp zq glide half whole fuel (Z.of_nat j) M = Some M' ->
  meant M' (propagator (schedule f 1 (p * q))).
Proof.
  revert j M; induction fuel as [|fuel IH]; intros j M J R; simpl; [discriminate|].
  pose proof (next_strike_after (Z.of_nat j) ltac:(lia)) as A.
  set (t := next_strike zp zq (Z.of_nat j)) in *.
  assert (PQ : (zp * zq = Z.of_nat (p * q))%Z) by (unfold zp, zq; lia).
  rewrite PQ; destruct (Z.ltb_spec t (Z.of_nat (p * q))) as [L|L].
  - assert (T : t = Z.of_nat (Z.to_nat t)) by lia.
    rewrite T; apply IH; [lia|]; apply leap; [lia | fold t; lia | exact R].
  - intros E; injection E; intros <-; apply leap; [lia | fold t; lia | exact R].
Qed.
End Run.

Lemma zrun_sound p q m n1 n2 k1 k2 fuel M : (1 <= p)%nat -> (1 <= q)%nat -> 0 < IZR m ->
  k1 / 2 = IZR n1 / IZR m -> k2 / 2 = IZR n2 / IZR m ->
  zrun (Z.of_nat p) (Z.of_nat q) m n1 n2 fuel = Some M ->
  represents M (propagator (schedule (two_clocks p q false false k1 k2) 1 (p * q))).
Proof.
  intros P Q m_pos E1 E2; pose proof (fun j => half_kick_spec p q k1 k2 P Q m n1 n2 j E1 E2) as K.
  refine (run_sound p q k1 k2 P Q _ _ _ represents (fun t Z M _ => represents_drift t Z M) _ _ fuel 0 _ M _ _).
  - intros j Z N R; rewrite K; now apply represents_kick.
  - intros j Z N R; replace (two_clocks p q false false k1 k2 j)
      with (IZR (2 * half_kick (Z.of_nat p) (Z.of_nat q) n1 n2 (Z.of_nat j)) / IZR m)
      by (pose proof (K j); rewrite mult_IZR; unfold Rdiv in *; lra); now apply represents_kick.
  - nia.
  - replace (kick _ ** propagator (schedule _ 1 0)) with (kick (IZR (n1 + n2) / IZR m) ** one).
    + apply represents_kick; [assumption|]; exists 1; simpl; repeat split; lra.
    + f_equal; f_equal; unfold two_clocks, strikes; rewrite !Nat.mod_0_l by lia; simpl.
      rewrite plus_IZR; unfold Rdiv in *; lra.
Qed.

Lemma classify_sound Z H : represents Z H -> row (classify Z) H.
Proof.
  intros (c & C & A & B & E & D); unfold classify.
  assert (S : forall z x, IZR z = c * x ->
    (Z.sgn z = 1%Z /\ 0 < x /\ (z =? 0)%Z = false) \/ (Z.sgn z = 0%Z /\ x = 0 /\ (z =? 0)%Z = true) \/
    (Z.sgn z = (-1)%Z /\ x < 0 /\ (z =? 0)%Z = false)).
  { intros z x X; destruct z as [|z|z]; simpl; [right; left | left | right; right];
      (split; [reflexivity | split; [|reflexivity]]).
    - apply Rmult_eq_reg_l with c; lra.
    - assert (0 < IZR (Zpos z)) by (apply IZR_lt; lia); nra.
    - assert (IZR (Zneg z) < 0) by (apply IZR_lt; lia); nra. }
  destruct (S _ _ B) as [(-> & b & ->)|[(-> & b & ->)|(-> & b & ->)]],
           (S _ _ E) as [(-> & e & ->)|[(-> & e & ->)|(-> & e & ->)]]; simpl;
    try nra; try (left; split; lra); try (right; split; lra); try (split; lra);
  destruct (S _ _ A) as [(-> & a & ->)|[(-> & a & ->)|(-> & a & ->)]],
           (S _ _ D) as [(-> & d & ->)|[(-> & d & ->)|(-> & d & ->)]]; simpl;
    try nra; try (left; split; lra); try (right; split; lra); try (split; nra); split; lra.
Qed.

Lemma same_kind_eq k l : same_kind k l = true -> k = l.
Proof. destruct k as [|[]|[]|[]], l as [|[]|[]|[]]; simpl; congruence. Qed.

Lemma Q2R_inject z : Q2R (inject_Z z) = IZR z.
Proof. unfold Q2R, inject_Z; simpl; field. Qed.

(** The unit of time is the tick: a row of the half period in ticks is the verdict. *)
Lemma in_ticks p q h1 L1 h2 L2 : (1 <= p)%nat -> (1 <= q)%nat -> 0 < h1 -> INR p * h1 = INR q * h2 ->
  propagator (schedule (two_clocks p q false false (h1 * L1 * tick q h1) (h2 * L2 * tick p h2)) 1 (p * q)) =
  rescale (/ tick q h1) (half_period p q h1 L1 h2 L2).
Proof.
  intros P Q H T; rewrite <- (tick_slow p q h1) by assumption.
  assert (Iq : 0 < INR q) by (apply lt_0_INR; lia).
  assert (dp : 0 < tick q h1) by (unfold tick; apply Rdiv_lt_0_compat; lra).
  set (d := tick q h1) in *.
  unfold half_period; rewrite <- scaling by (apply Rinv_neq_0_compat; lra); fold d.
  rewrite Rinv_r by lra; f_equal; apply schedule_ext; intros j _; unfold two_clocks.
  destruct (strikes q false j), (strikes p false j); field; lra.
Qed.

Lemma verdict_in_ticks k p q h1 L1 h2 L2 :
  (1 <= p /\ 1 <= q /\ Nat.gcd p q = 1)%nat -> 0 < h1 -> 0 < h2 -> INR p * h1 = INR q * h2 ->
  row k (propagator (schedule (two_clocks p q false false (h1 * L1 * tick q h1) (h2 * L2 * tick p h2)) 1 (p * q))) ->
  verdict k p q h1 L1 h2 L2.
Proof.
  intros (Pp & Pq & G) H1 H2 T R.
  assert (Iq : 0 < INR q) by (apply lt_0_INR; lia).
  assert (dp : 0 < tick q h1) by (unfold tick; apply Rdiv_lt_0_compat; lra).
  rewrite in_ticks in R by assumption; set (d := tick q h1) in *.
  split; [auto | auto |].
  set (H := half_period p q h1 L1 h2 L2) in *.
  apply two_clocks_verdict; [assumption..|]; fold H.
  destruct k as [|[]|[]|[]]; simpl in R |- *;
    replace (mB H * / d * (mC H / / d)) with (mB H * mC H) in R by (field; lra); auto.
  all: assert (X : forall b, b * / d = 0 <-> b = 0) by
         (intros b; split; [intros Z; apply Rmult_eq_reg_r with (/ d); [lra | apply Rinv_neq_0_compat; lra] | intros ->; ring]);
       assert (Y : forall b, b / / d = 0 <-> b = 0) by
         (intros b; split; [intros Z; apply Rmult_eq_reg_r with (/ / d); [unfold Rdiv in Z; lra |
            apply Rinv_neq_0_compat, Rinv_neq_0_compat; lra] | intros ->; unfold Rdiv; ring]);
       rewrite X, Y in R; exact R.
Qed.

Theorem certificate k p q h1 L1 h2 L2 x1 l1 x2 l2 :
  x1 = Q2R h1 -> l1 = Q2R L1 -> x2 = Q2R h2 -> l2 = Q2R L2 ->
  check k p q h1 L1 h2 L2 = true ->
  verdict k p q x1 l1 x2 l2.
Proof.
  intros -> -> -> -> C; unfold check in C.
  set (m := Z.to_pos _) in C; set (n1 := (Qnum (Qred (h1 * h1 * L1 / (4 * inject_Z (Z.of_nat q)))) * _)%Z) in C;
  set (n2 := (Qnum (Qred (h2 * h2 * L2 / (4 * inject_Z (Z.of_nat p)))) * _)%Z) in C; clearbody m n1 n2.
  repeat rewrite Bool.andb_true_iff in C.
  destruct C as ((((((((Pp & Pq) & G) & H1) & H2) & T) & N1) & N2) & K).
  apply Nat.leb_le in Pp, Pq; apply Nat.eqb_eq in G; apply Z.ltb_lt in H1, H2.
  apply Qeq_bool_eq, Qeq_eqR in T, N1, N2.
  assert (Hpos : forall h, (0 < Qnum h)%Z -> 0 < Q2R h).
  { intros h P; unfold Q2R; apply Rmult_lt_0_compat; [now apply IZR_lt|].
    apply Rinv_0_lt_compat, IZR_lt; lia. }
  apply Hpos in H1, H2; rewrite !Q2R_mult, !Q2R_inject in T.
  assert (Ip : 0 < INR p) by (apply lt_0_INR; lia); assert (Iq : 0 < INR q) by (apply lt_0_INR; lia).
  rewrite <- !INR_IZR_INZ in T.
  assert (Strength : forall h L c n, (1 <= c)%nat ->
     Q2R (n # m) = Q2R (Qred (h * h * L / (4 * inject_Z (Z.of_nat c)))) ->
     Q2R h * Q2R L * tick c (Q2R h) / 2 = IZR n / IZR (Zpos m)).
  { intros h L c n Cp E; assert (0 < INR c) by (apply lt_0_INR; lia).
    transitivity (Q2R (n # m)); [|reflexivity].
    rewrite E, (Qeq_eqR _ _ (Qred_correct _)); unfold Qdiv.
    rewrite Q2R_mult, Q2R_inv, !Q2R_mult, Q2R_inject, <- INR_IZR_INZ.
    - unfold tick; replace (Q2R 4) with 4 by (unfold Q2R; simpl; field); field; lra.
    - intros Z; apply (Qeq_eqR _ 0%Q) in Z; rewrite Q2R_mult, Q2R_inject, <- INR_IZR_INZ in Z.
      unfold Q2R in Z; simpl in Z; lra. }
  apply Strength in N1, N2; [|assumption..]; clear Strength.
  destruct (zrun _ _ _ _ _ _) as [M|] eqn:E; [|discriminate].
  apply same_kind_eq in K; subst k.
  apply verdict_in_ticks; [auto | assumption..|]; apply classify_sound.
  refine (zrun_sound p q (Zpos m) n1 n2 _ _ _ M Pp Pq _ N1 N2 E); apply IZR_lt; lia.
Qed.

(** [certify h1 L1 h2 L2]: the rationals h1 ... as elements of Q, denominators positive. *)
Ltac certify h1 L1 h2 L2 :=
  apply (certificate _ _ _ h1%Q L1%Q h2%Q L2%Q);
  [ cbv [Q2R Qnum Qden]; lra .. | vm_cast_no_check (eq_refl true) ].
