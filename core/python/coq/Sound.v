(* Each claim keeps the relations that the operations keep; so what holds for fractions of polynomials holds in each field. *)

Require Import ZArith List Bool Lia FMapPositive Field Ring_polynom.
Require Import Liestep.Numbers Liestep.Step.
Import ListNotations.

(* Lists *)

Lemma length_rel {A B} (Q : A -> B -> Prop) l m : Forall2 Q l m -> length l = length m.
Proof. induction 1; simpl; auto. Qed.
Lemma map_rel {A B C D} (S : A -> B -> Prop) (Q : C -> D -> Prop) f g l m :
  Forall2 S l m -> (forall x y, S x y -> Q (f x) (g y)) -> Forall2 Q (map f l) (map g m).
Proof. induction 1; simpl; constructor; auto. Qed.
Lemma map_same {A C D} (Q : C -> D -> Prop) (f : A -> C) g l : (forall x, Q (f x) (g x)) -> Forall2 Q (map f l) (map g l).
Proof. induction l; simpl; constructor; auto. Qed.
Lemma seq_rel {C D} (Q : C -> D -> Prop) f g s m k : m = k -> (forall x, Q (f x) (g x)) -> Forall2 Q (map f (seq s m)) (map g (seq s k)).
Proof. intros -> ?; apply map_same; auto. Qed.
Lemma nth_rel {A B} (Q : A -> B -> Prop) k l m d e : Forall2 Q l m -> Q d e -> Q (nth k l d) (nth k m e).
Proof. intro h; revert k; induction h; intros [|]; simpl; auto. Qed.
Lemma firstn_rel {A B} (Q : A -> B -> Prop) k l m : Forall2 Q l m -> Forall2 Q (firstn k l) (firstn k m).
Proof. intro h; revert k; induction h; intros [|]; simpl; constructor; auto. Qed.
Lemma skipn_rel {A B} (Q : A -> B -> Prop) k l m : Forall2 Q l m -> Forall2 Q (skipn k l) (skipn k m).
Proof. intro h; revert k; induction h; intros [|]; simpl; auto. Qed.
Lemma concat_rel {A B} (Q : A -> B -> Prop) l m : Forall2 (Forall2 Q) l m -> Forall2 Q (concat l) (concat m).
Proof. induction 1; simpl; [constructor | apply Forall2_app; auto]. Qed.
Lemma fold_rel {A B} (Q : A -> B -> Prop) f g l m : Forall2 Q l m -> (forall a b x y, Q a x -> Q b y -> Q (f a b) (g x y)) ->
  forall a x, Q a x -> Q (fold_left f l a) (fold_left g m x).
Proof. induction 1; simpl; auto. Qed.

Section Functions.
Variables (p q : ops) (R : T p -> T q -> Prop).
Hypothesis keeps : related p q R.
Notation V := (Forall2 R).
Notation M := (Forall2 (Forall2 R)).
Notation L := (Forall2 (Forall2 (Forall2 R))).

Lemma whole_rel z : R (whole p z) (whole q z). Proof. apply of_whole; auto. Qed.
Lemma add_rel a x b y : R a x -> R b y -> R (add p a b) (add q x y). Proof. apply of_add; auto. Qed.
Lemma sub_rel a x b y : R a x -> R b y -> R (sub p a b) (sub q x y). Proof. apply of_sub; auto. Qed.
Lemma mul_rel a x b y : R a x -> R b y -> R (mul p a b) (mul q x y). Proof. apply of_mul; auto. Qed.
Lemma div_rel a x b y : R a x -> R b y -> R (div p a b) (div q x y). Proof. apply of_div; auto. Qed.
Lemma opp_rel a x : R a x -> R (opp p a) (opp q x). Proof. apply of_opp; auto. Qed.
Lemma call_rel f a x : R a x -> R (call p f a) (call q f x). Proof. apply of_call; auto. Qed.
Lemma ratio_rel z : R (ratio p z) (ratio q z).
Proof. unfold ratio; destruct (snd z =? 1)%Z; [apply whole_rel | apply div_rel; apply whole_rel]. Qed.
Lemma at_rel k l m : V l m -> R (at_ p k l) (at_ q k m). Proof. intro; unfold at_; apply (nth_rel R); auto using whole_rel. Qed.
Lemma row_rel k l m : M l m -> V (nth k l []) (nth k m []). Proof. intro; apply (nth_rel V); auto. Qed.
Lemma matrix_rel k l m : L l m -> M (nth k l []) (nth k m []). Proof. intro; apply (nth_rel M); auto. Qed.
Lemma entry_rel a x i j : M a x -> R (entry p a i j) (entry q x i j). Proof. intro; apply at_rel; apply row_rel; auto. Qed.
Lemma rows_rel a x : M a x -> rows p a = rows q x. Proof. apply length_rel. Qed.
Lemma columns_rel a x : M a x -> columns p a = columns q x. Proof. intro; unfold columns; exact (length_rel _ _ _ (row_rel 0 _ _ H)). Qed.
Lemma tab_rel m n m' n' f g : m = m' -> n = n' -> (forall i j, R (f i j) (g i j)) -> M (tab p m n f) (tab q m' n' g).
Proof. intros -> -> h; apply map_same; intro; apply map_same; auto. Qed.
Lemma sum_rel n n' f g : n = n' -> (forall k, R (f k) (g k)) -> R (sum p n f) (sum q n' g).
Proof.
  intros -> h; induction n' as [| [| k] IH]; [apply whole_rel | apply h |].
  change (R (add p (sum p (S k) f) (f (S k))) (add q (sum q (S k) g) (g (S k)))); apply add_rel; auto.
Qed.

Ltac rel := repeat (cbn beta zeta; match goal with
  | |- forall _, _ => intro
  | H : ?a |- ?a => exact H
  | |- ?a = ?a => reflexivity
  | |- _ (whole _ _) (whole _ _) => apply whole_rel
  | |- _ (add _ _ _) (add _ _ _) => apply add_rel
  | |- _ (sub _ _ _) (sub _ _ _) => apply sub_rel
  | |- _ (mul _ _ _) (mul _ _ _) => apply mul_rel
  | |- _ (div _ _ _) (div _ _ _) => apply div_rel
  | |- _ (opp _ _) (opp _ _) => apply opp_rel
  | |- _ (call _ _ _) (call _ _ _) => apply call_rel
  | |- _ (ratio _ _) (ratio _ _) => apply ratio_rel
  | |- _ (at_ _ _ _) (at_ _ _ _) => apply at_rel
  | |- _ (entry _ _ _ _) (entry _ _ _ _) => apply entry_rel
  | |- _ (sum _ _ _) (sum _ _ _) => apply sum_rel
  | |- rows _ _ = rows _ _ => apply rows_rel
  | |- columns _ _ = columns _ _ => apply columns_rel
  | |- _ (tab _ _ _ _) (tab _ _ _ _) => apply tab_rel
  | |- _ (if ?b then _ else _) (if ?b then _ else _) => destruct b
  | |- Forall2 _ (map _ (seq _ _)) (map _ (seq _ _)) => apply seq_rel
  | |- Forall2 _ (map _ ?l) (map _ ?l) => apply map_same
  | |- Forall2 _ (map _ _) (map _ _) => eapply map_rel
  | |- Forall2 _ [] [] => constructor
  | |- Forall2 _ (_ :: _) (_ :: _) => constructor
  | |- Forall2 _ (_ ++ _) (_ ++ _) => apply Forall2_app
  | |- Forall2 _ (nth _ _ []) (nth _ _ []) => first [apply row_rel | apply matrix_rel]
  | |- Forall2 _ (firstn _ _) (firstn _ _) => apply firstn_rel
  | |- Forall2 _ (skipn _ _) (skipn _ _) => apply skipn_rel
  | |- Forall2 _ (concat _) (concat _) => apply concat_rel
  | |- length _ = length _ => eapply length_rel
  | |- S _ = S _ => f_equal
  | |- pred _ = pred _ => f_equal
  | |- (_ + _)%nat = (_ + _)%nat => f_equal
  end).

Lemma madd_rel a x b y : M a x -> M b y -> M (madd p a b) (madd q x y). Proof. unfold madd, pointwise; rel. Qed.
Lemma msub_rel a x b y : M a x -> M b y -> M (msub p a b) (msub q x y). Proof. unfold msub, pointwise; rel. Qed.
Lemma scaled_rel s z a x : R s z -> M a x -> M (scaled p s a) (scaled q z x).
Proof. intros; eapply map_rel; [eassumption |]; intros; eapply map_rel; [eassumption |]; rel. Qed.
Lemma quotient_rel a x s z : M a x -> R s z -> M (quotient p a s) (quotient q x z).
Proof. intros; eapply map_rel; [eassumption |]; intros; eapply map_rel; [eassumption |]; rel. Qed.
Lemma opposite_rel a x : M a x -> M (opposite p a) (opposite q x).
Proof. intros; eapply map_rel; [eassumption |]; intros; eapply map_rel; [eassumption |]; rel. Qed.
Lemma turned_rel a x : M a x -> M (turned p a) (turned q x). Proof. unfold turned; rel. Qed.
Lemma mmul_rel a x b y : M a x -> M b y -> M (mmul p a b) (mmul q x y).
Proof. intros; unfold mmul; pose proof (turned_rel _ _ H0); rel. Qed.
Lemma trace_rel a x : M a x -> R (trace p a) (trace q x). Proof. unfold trace; rel. Qed.
Lemma inner_rel a x b y : M a x -> M b y -> R (inner p a b) (inner q x y). Proof. unfold inner; rel. Qed.
Lemma unit_rel n : M (unit p n) (unit q n). Proof. unfold unit; rel. Qed.
Lemma column_rel l m : V l m -> M (column p l) (column q m). Proof. intro; eapply map_rel; [eassumption |]; rel. Qed.
Lemma dot_rel a x b y : V a x -> V b y -> R (dot p a b) (dot q x y).
Proof. intros; unfold dot; rel; eassumption. Qed.
Lemma zip_rel f g a x b y : V a x -> V b y -> (forall a b x y, R a x -> R b y -> R (f a b) (g x y)) -> V (zip p f a b) (zip q g x y).
Proof. intros h k s; unfold zip; apply seq_rel; [eapply length_rel; eassumption | intro; apply s; rel]. Qed.
Lemma signed_rel k a x : R a x -> R (signed p k a) (signed q k x). Proof. unfold signed; rel. Qed.
Lemma without_rel i j a x : M a x -> M (without p i j a) (without q i j x). Proof. unfold without; rel. Qed.
Lemma det_rel n : forall a x, M a x -> R (det p n a) (det q n x).
Proof.
  induction n as [| n IH]; intros a x h; [cbn; rel |]; destruct n as [| k]; [cbn [det]; rel |].
  change (R (sum p (S (S k)) (fun j => signed p j (mul p (entry p a 0 j) (det p (S k) (without p 0 j a)))))
            (sum q (S (S k)) (fun j => signed q j (mul q (entry q x 0 j) (det q (S k) (without q 0 j x)))))).
  apply sum_rel; auto; intro; apply signed_rel, mul_rel; [rel | apply IH, without_rel; auto].
Qed.
Lemma inverse_rel n a x : M a x -> M (inverse p n a) (inverse q n x).
Proof.
  intro; unfold inverse; apply quotient_rel; [| apply det_rel; auto].
  apply tab_rel; auto; intros; apply signed_rel; apply det_rel; apply without_rel; auto.
Qed.
Lemma cut_rel s : forall l m, V l m -> L (cut p s l) (cut q s m).
Proof. induction s as [| [n m] s IH]; cbn [cut]; rel; apply IH; rel. Qed.
Lemma each_rel f g l : (forall s a x, V a x -> M (f s a) (g s x)) -> forall y z, V y z -> L (each p f l y) (each q g l z).
Proof. intro h; induction l as [| s l IH]; cbn [each]; rel; [apply h; rel | apply IH; rel]. Qed.
Lemma products_rel a x : L a x -> forall b y, L b y -> L (products p a b) (products q x y).
Proof. induction 1 as [| s t l m]; intros b z k; destruct k; cbn [products]; constructor; auto using mmul_rel. Qed.

(* Programs *)

Definition same_place (a : option (T p)) (b : option (T q)) : Prop :=
  match a, b with Some a, Some b => R a b | None, None => True | _, _ => False end.
Definition same_registers (m : registers p) (n : registers q) := forall k, same_place (PositiveMap.find k m) (PositiveMap.find k n).
Lemma get_rel m n k : same_registers m n -> R (get p m k) (get q n k).
Proof. intro h; specialize (h k); unfold get; destruct (PositiveMap.find k m), (PositiveMap.find k n); cbn in h; try tauto; rel. Qed.
Lemma put_rel m n k a x : same_registers m n -> R a x -> same_registers (PositiveMap.add k a m) (PositiveMap.add k x n).
Proof. intros h r j; destruct (Pos.eq_dec j k) as [-> | d]; [rewrite !PositiveMap.gss | rewrite !PositiveMap.gso by auto]; auto. Qed.
Lemma empty_rel : same_registers (PositiveMap.empty _) (PositiveMap.empty _).
Proof. intro k; rewrite !PositiveMap.gempty; exact I. Qed.
Lemma loaded_rel l x : V l x -> forall k m n, same_registers m n -> same_registers (loaded p k l m) (loaded q k x n).
Proof. induction 1; cbn [loaded]; auto using put_rel. Qed.
Lemma applied_rel m n op : same_registers m n -> R (applied p m op) (applied q n op).
Proof. intro; destruct op; cbn [applied]; rel; apply get_rel; auto. Qed.
Lemma executed_rel s l : forall k m n, same_registers m n -> same_registers (executed p s k l m) (executed q s k l n).
Proof.
  induction l as [| op l IH]; cbn [executed]; auto; intros; apply IH; apply put_rel; auto.
  destruct (has s k); [| apply (of_idle p q R keeps)]; apply applied_rel; auto.
Qed.
Lemma run_rel c i j a x : M a x -> V (run p c i j a) (run q c i j x).
Proof.
  intro h; unfold run.
  assert (s : V (map (fun s => entry p a (fst s) (snd s)) (inputs c) ++ map (ratio p) (literals c))
                (map (fun s => entry q x (fst s) (snd s)) (inputs c) ++ map (ratio q) (literals c))) by rel.
  cbn zeta; rewrite (length_rel _ _ _ s); apply map_same; intro; apply get_rel, executed_rel, loaded_rel; auto using empty_rel.
Qed.
Lemma freed_rel s l x y : same_registers x y -> forall k m n, same_registers m n -> same_registers (freed p s k l x m) (freed q s k l y n).
Proof.
  intro h; induction l as [| op l IH]; cbn [freed]; auto; intros; apply IH; apply put_rel; auto.
  specialize (h k); destruct (PositiveMap.find k x), (PositiveMap.find k y); cbn in h; try tauto.
  destruct (has s k); [| apply (of_idle p q R keeps)]; apply applied_rel; auto.
Qed.
Lemma placed_rel l : forall a x m n, V a x -> same_registers m n -> same_registers (placed p l a m) (placed q l x n).
Proof. induction l; intros a' x m n h; destruct h; cbn [placed]; auto using put_rel. Qed.
Lemma run_after_rel c i j b y a x : V b y -> M a x -> V (run_after p c i j b a) (run_after q c i j y x).
Proof.
  intros g h; unfold run_after; cbn zeta.
  assert (s : V (map (fun s => entry p a (fst s) (snd s)) (inputs c)) (map (fun s => entry q x (fst s) (snd s)) (inputs c))) by rel.
  assert (r : V (map (ratio p) (literals c)) (map (ratio q) (literals c))) by rel.
  rewrite (length_rel _ _ _ s), (length_rel _ _ _ r); apply map_same; intro; apply get_rel, freed_rel; auto using placed_rel, loaded_rel, empty_rel.
Qed.

(* The group *)

Lemma rational_rel m : M (rational p m) (rational q m). Proof. unfold rational; rel. Qed.
Lemma hat_rel f y z : V y z -> M (hat p f y) (hat q f z).
Proof.
  intro; assert (e : L (map (rational p) (generators f)) (map (rational q) (generators f))) by (apply map_same; apply rational_rel).
  unfold hat; cbn zeta; apply tab_rel; auto; intros; apply sum_rel; [exact (length_rel _ _ _ e) |]; intro.
  apply mul_rel; [rel | apply entry_rel, matrix_rel, e].
Qed.
Lemma cayley_rel n a x : M a x -> M (cayley p n a) (cayley q n x).
Proof. intro; unfold cayley; apply mmul_rel; [apply inverse_rel, msub_rel | apply madd_rel]; auto using unit_rel. Qed.
Lemma single_rel f s y z k : V y z -> M (single p f s y k) (single q f s z k).
Proof. intro; unfold single; apply cayley_rel, scaled_rel; rel; apply rational_rel. Qed.
Lemma increment_rel f y z : V y z -> M (increment p f y) (increment q f z).
Proof.
  intro; unfold increment; destruct (is_product f); [| apply cayley_rel, hat_rel; auto].
  apply fold_rel; auto using mmul_rel, unit_rel; apply map_same; intro; apply single_rel; auto.
Qed.
Lemma back_rel f y z : V y z -> M (back p f y) (back q f z).
Proof.
  intro; unfold back; destruct (is_product f); [| apply cayley_rel, opposite_rel, hat_rel; auto].
  apply fold_rel; auto using mmul_rel, unit_rel; apply map_same; intro; apply single_rel; auto.
Qed.
Lemma moved_rel f x g y a w z : L f x -> L g y -> M w z -> M (moved p f g a w) (moved q x y a z).
Proof.
  intros; destruct a; unfold moved; auto; repeat apply mmul_rel; try apply turned_rel; auto; apply matrix_rel; auto.
Qed.
Lemma all_moved_rel f x g y l : L f x -> L g y -> forall w z, L w z -> L (all_moved p f g l w) (all_moved q x y l z).
Proof.
  intros hf hg; induction l as [| a l IH]; intros w z h; destruct h; cbn [all_moved]; constructor; auto using moved_rel.
Qed.
Lemma completed_rel a w z : M w z -> M (completed p a w) (completed q a z).
Proof. intro; unfold completed; rel. Qed.
Lemma stored_rel l : forall w z, L w z -> V (stored p l w) (stored q l z).
Proof. induction l as [| a l IH]; intros w z h; destruct h; cbn [stored]; rel; auto. Qed.
Lemma transported_rel l : forall f x g y n z, L f x -> L g y -> V n z -> V (transported p l f g n) (transported q l x y z).
Proof.
  induction l as [| s l IH]; intros f x g y n z hf hg hn; destruct hf, hg; cbn [transported]; cbn zeta; [constructor .. |].
  apply Forall2_app; [| apply IH; rel].
  eapply (map_rel V R); [| intros; apply dot_rel; [apply firstn_rel; eassumption | eassumption]].
  apply map_same; intro; apply map_same; intro; apply inner_rel; [apply rational_rel |].
  apply mmul_rel; auto; apply mmul_rel; auto; apply rational_rel.
Qed.

(* Texts *)

Lemma value_rel t : forall w z, L w z -> M (value p t w) (value q t z).
Proof.
  induction t; intros w z h; cbn [value]; cbn zeta;
    repeat match goal with IH : forall w z, L w z -> M (value p ?t w) _ |- _ =>
      lazymatch goal with k : M (value p t w) _ |- _ => fail | _ => pose proof (IH _ _ h) end end;
    auto using madd_rel, msub_rel, mmul_rel, opposite_rel, turned_rel.
  - rel.
  - apply matrix_rel; auto.
  - apply scaled_rel; rel.
  - apply quotient_rel; rel.
  - rel; apply trace_rel; auto.
  - match goal with a : M (value p t w) _ |- _ => rewrite (rows_rel _ _ a) end; apply inverse_rel; auto.
  - rel.
  - rel.
  - match goal with a : M (value p t1 w) _, b : M (value p t2 w) _ |- _ =>
      rewrite (rows_rel _ _ a), (columns_rel _ _ a), (columns_rel _ _ b) end; rel.
  - rel.
Qed.

(* Rules *)

Definition same_call (a : function * T p * T p) (b : function * T q * T q) : Prop :=
  fst (fst a) = fst (fst b) /\ R (snd (fst a)) (snd (fst b)) /\ R (snd a) (snd b).
Lemma number_rel t w z : L w z -> R (number_of p t w) (number_of q t z).
Proof. intro; apply entry_rel, value_rel; auto. Qed.
Lemma unknown_rel w z k : L w z -> R (unknown p w k) (unknown q z k).
Proof. intro; apply entry_rel, matrix_rel; auto. Qed.
Lemma of_nat_rel k : R (of_nat p k) (of_nat q k). Proof. apply whole_rel. Qed.
Lemma numbered_rel f a x l m : R a x -> V l m -> Forall2 same_call (numbered p f a l) (numbered q f x m).
Proof.
  intros h k; unfold numbered; apply seq_rel; [exact (length_rel _ _ _ k) | intro; split; [reflexivity | split; cbn [fst snd]; [exact h | apply at_rel; exact k]]].
Qed.
Lemma stumpffs_rel a x n : R a x -> forall j f c d c' d', R c c' -> R d d' -> V (stumpffs p a n j f c d) (stumpffs q x n j f c' d').
Proof. intro; induction n; cbn [stumpffs]; constructor; auto; apply IHn; rel. Qed.
Lemma stumpffs_of_0_rel n : forall j f, V (stumpffs_of_0 p n j f) (stumpffs_of_0 q n j f).
Proof. induction n; cbn [stumpffs_of_0]; constructor; auto; rel. Qed.
Lemma ratios_rel s t u v n : R s t -> R u v -> forall k b g b' g', R b b' -> R g g' -> V (ratios p s u n k b g) (ratios q t v n k b' g').
Proof. intros; revert k b g b' g' H1 H2; induction n; cbn [ratios]; intros; constructor; auto; apply IHn; auto; destruct k; rel; apply of_nat_rel. Qed.
Lemma ratios_of_0_rel n : forall k g g', R g g' -> V (ratios_of_0 p n k g) (ratios_of_0 q n k g').
Proof. induction n; cbn [ratios_of_0]; constructor; auto; apply IHn; rel; apply of_nat_rel. Qed.
Lemma calls_rel r w z : L w z -> Forall2 same_call (calls p r w) (calls q r z).
Proof.
  intro h; destruct r; cbn [calls]; cbn zeta;
    repeat match goal with
    | |- Forall2 _ (_ ++ _) (_ ++ _) => apply Forall2_app
    | |- Forall2 same_call (numbered _ _ _ _) (numbered _ _ _ _) => apply numbered_rel
    | |- Forall2 same_call (_ :: _) (_ :: _) => constructor
    | |- Forall2 same_call [] [] => constructor
    | |- same_call _ _ => split; [reflexivity | split; cbn [fst snd]]
    | |- _ (of_nat _ _) (of_nat _ _) => apply of_nat_rel
    | |- _ (number_of _ _ _) (number_of _ _ _) => apply number_rel
    | |- _ (unknown _ _ _) (unknown _ _ _) => apply unknown_rel
    | |- _ (stumpffs _ _ _ _ _ _ _) _ => apply stumpffs_rel
    | |- _ (stumpffs_of_0 _ _ _ _) _ => apply stumpffs_of_0_rel
    | |- _ (ratios _ _ _ _ _ _ _) _ => apply ratios_rel
    | |- _ (ratios_of_0 _ _ _ _) _ => apply ratios_of_0_rel
    | |- _ (add _ _ _) (add _ _ _) => apply add_rel
    | |- _ (sub _ _ _) (sub _ _ _) => apply sub_rel
    | |- _ (mul _ _ _) (mul _ _ _) => apply mul_rel
    | |- _ (div _ _ _) (div _ _ _) => apply div_rel
    | |- _ (opp _ _) (opp _ _) => apply opp_rel
    end; auto.
Qed.
End Functions.

(* Claims *)

Section Claims.
Variables (s t : ops) (R : T s -> T t -> Prop).
Hypothesis keeps : related s t R.
Definition dual_keeps := dual_related s t R keeps.
Variable c : certificate.
Variables (v : list (list (T s))) (x : list (list (T t))).
Hypothesis given : Forall2 (Forall2 R) v x.
Notation V := (Forall2 R).
Notation M := (Forall2 (Forall2 R)).
Notation L := (Forall2 (Forall2 (Forall2 R))).
Notation L2 := (Forall2 (Forall2 (Forall2 (pair R)))).
Definition agree (e : equation s) (f : equation t) : Prop := V (fst e) (fst f) /\ V (snd e) (snd f).

Ltac go := repeat (cbn beta zeta; match goal with
  | |- forall _, _ => intro
  | H : ?a |- ?a => exact H
  | |- related _ _ _ => first [exact keeps | exact dual_keeps]
  | |- ?a = ?a => reflexivity
  | |- _ /\ _ => split
  | |- _ (fst (_, _)) (fst (_, _)) => cbn [fst]
  | |- _ (snd (_, _)) (snd (_, _)) => cbn [snd]
  | |- _ (whole _ _) (whole _ _) => apply whole_rel
  | |- _ (add _ _ _) (add _ _ _) => apply add_rel
  | |- _ (sub _ _ _) (sub _ _ _) => apply sub_rel
  | |- _ (mul _ _ _) (mul _ _ _) => apply mul_rel
  | |- _ (div _ _ _) (div _ _ _) => apply div_rel
  | |- _ (dot _ _ _) (dot _ _ _) => apply dot_rel
  | |- _ (at_ _ _ _) (at_ _ _ _) => apply at_rel
  | |- _ (entry _ _ _ _) (entry _ _ _ _) => apply entry_rel
  | |- _ (number_of _ _ _) (number_of _ _ _) => unfold number_of
  | |- _ (unit _ _) (unit _ _) => apply unit_rel
  | |- _ (madd _ _ _) (madd _ _ _) => apply madd_rel
  | |- _ (msub _ _ _) (msub _ _ _) => apply msub_rel
  | |- _ (mmul _ _ _) (mmul _ _ _) => apply mmul_rel
  | |- _ (scaled _ _ _) (scaled _ _ _) => apply scaled_rel
  | |- _ (column _ _) (column _ _) => apply column_rel
  | |- _ (hat _ _ _) (hat _ _ _) => apply hat_rel
  | |- _ (increment _ _ _) (increment _ _ _) => apply increment_rel
  | |- _ (back _ _ _) (back _ _ _) => apply back_rel
  | |- _ (each _ _ _ _) (each _ _ _ _) => apply each_rel
  | |- _ (products _ _ _) (products _ _ _) => apply products_rel
  | |- _ (cut _ _ _) (cut _ _ _) => apply cut_rel
  | |- _ (moved _ _ _ _ _) (moved _ _ _ _ _) => apply moved_rel
  | |- _ (all_moved _ _ _ _ _) (all_moved _ _ _ _ _) => apply all_moved_rel
  | |- _ (completed _ _ _) (completed _ _ _) => apply completed_rel
  | |- _ (stored _ _ _) (stored _ _ _) => apply stored_rel
  | |- _ (transported _ _ _ _ _) (transported _ _ _ _ _) => apply transported_rel
  | |- _ (value _ _ _) (value _ _ _) => apply value_rel
  | |- _ (run _ _ _ _ _) (run _ _ _ _ _) => apply run_rel
  | |- _ (zip _ _ _ _) (zip _ _ _ _) => apply zip_rel
  | |- _ (tab _ _ _ _) (tab _ _ _ _) => apply tab_rel
  | |- _ (if ?b then _ else _) (if ?b then _ else _) => destruct b
  | |- Forall2 _ (map _ (seq _ _)) (map _ (seq _ _)) => apply seq_rel
  | |- Forall2 _ (map _ ?l) (map _ ?l) => apply map_same
  | |- Forall2 _ [] [] => constructor
  | |- Forall2 _ (_ :: _) (_ :: _) => constructor
  | |- Forall2 _ (_ ++ _) (_ ++ _) => apply Forall2_app
  | |- Forall2 _ (nth _ _ []) (nth _ _ []) => first [apply row_rel | apply matrix_rel]
  | |- Forall2 _ (firstn _ _) (firstn _ _) => apply firstn_rel
  | |- Forall2 _ (skipn _ _) (skipn _ _) => apply skipn_rel
  | |- Forall2 _ (concat _) (concat _) => apply concat_rel
  end).

Lemma scope_rel (o u : ops) (Q : T o -> T u -> Prop) h k p l f i g j w z a b d e : related o u Q ->
  Q h k -> Forall2 Q p l -> Forall2 (Forall2 (Forall2 Q)) f i -> Forall2 (Forall2 (Forall2 Q)) g j -> Forall2 (Forall2 (Forall2 Q)) w z ->
  Forall2 Q a b -> Forall2 Q d e -> Forall2 (Forall2 (Forall2 Q)) (scope o c h p f g w a d) (scope u c k l i j z b e).
Proof. intros; unfold scope; go. Qed.
Lemma flat_rel (o u : ops) (Q : T o -> T u -> Prop) a b : Forall2 (Forall2 (Forall2 Q)) a b -> Forall2 Q (flat o a) (flat u b).
Proof. intro; unfold flat; apply concat_rel; eapply map_rel; [eassumption |]; intros; apply concat_rel; auto. Qed.
Lemma in_place_rel a b d e : V a b -> V d e -> L (in_place s c a d) (in_place t c b e).
Proof.
  intros same there; unfold in_place; cbn zeta; generalize (cut_rel s t R keeps (map shape (advected c)) a b same).
  generalize (cut s (map shape (advected c)) a), (cut t (map shape (advected c)) b).
  induction (advected c) as [| i l IH]; intros x_ y_ pairs; destruct pairs as [| m n x_ y_ pairs rest]; cbn [combine map]; constructor; auto.
  destruct (in_group (acts i)), (in_products c); cbn zeta; go; try (eapply rows_rel; eassumption); try (eapply columns_rel; eassumption).
Qed.
Lemma h_rel : R (h s v) (h t x). Proof. unfold h; go. Qed.
Lemma v_rel k : V (nth k v []) (nth k x []). Proof. go. Qed.
Lemma p_rel : V (p s v) (p t x). Proof. exact (v_rel 1). Qed.
Lemma none_rel : V (none s c) (none t c). Proof. unfold none; go. Qed.
Lemma ones_rel : V (ones s c) (ones t c). Proof. unfold ones; go. Qed.
Lemma axis_rel k : V (axis s c k) (axis t c k). Proof. unfold axis; go. Qed.
Lemma F_rel : L (F s c v) (F t c x). Proof. unfold F, y; go. Qed.
Lemma G_rel : L (G s c v) (G t c x). Proof. unfold G, y; go. Qed.
Lemma w_rel : L (w s c v) (w t c x). Proof. unfold w; apply in_place_rel; go. Qed.
Lemma other_rel : L (other s c v) (other t c x). Proof. unfold other; apply in_place_rel; go. Qed.
Lemma g_rel : L (g s c v) (g t c x). Proof. unfold g; go. Qed.
Lemma g_back_rel : L (g_back s c v) (g_back t c x). Proof. unfold g_back; go. Qed.
Lemma arrays_rel (o u : ops) (Q : T o -> T u -> Prop) e f y y' a a' m m' w w' g g' : related o u Q ->
  Forall2 (Forall2 Q) e f -> Forall2 Q y y' -> Forall2 Q a a' -> Forall2 Q m m' -> Forall2 (Forall2 (Forall2 Q)) w w' ->
  Forall2 (Forall2 (Forall2 Q)) g g' -> Forall2 (Forall2 Q) (arrays o c e y a m w g) (arrays u c f y' a' m' w' g').
Proof. intros; unfold arrays, h, p, history; go; apply flat_rel; auto. Qed.
Lemma system_rel (o u : ops) (Q : T o -> T u -> Prop) i j e f y y' a a' w w' : related o u Q ->
  Forall2 (Forall2 Q) e f -> Forall2 Q y y' -> Forall2 Q a a' -> Forall2 (Forall2 (Forall2 Q)) w w' ->
  Forall2 Q (system o c e i j y a w) (system u c f i j y' a' w').
Proof. intros; unfold system, none; apply run_rel; auto; apply arrays_rel; go. Qed.
Lemma kick_rel w w' : L w w' -> V (kick s c v w) (kick t c x w').
Proof. intro; unfold kick; apply run_rel; auto; apply arrays_rel; auto using none_rel. Qed.
Lemma ended_rel i j a a' m m' : V a a' -> V m m' -> V (ended s c v i j a m) (ended t c x i j a' m').
Proof. intros; unfold ended, y; apply run_rel; auto; apply arrays_rel; auto using w_rel, g_rel, v_rel. Qed.

Lemma still_rel a b : R a b -> pair R (still s a) (still t b). Proof. unfold still, pair; go. Qed.
Lemma still_row l m : V l m -> Forall2 (pair R) (map (still s) l) (map (still t) m).
Proof. intro; eapply map_rel; eauto using still_rel. Qed.
Lemma stills_rel l m : L l m -> L2 (stills s l) (stills t m).
Proof. intro; unfold stills; eapply map_rel; [eassumption |]; intros; eapply map_rel; [eassumption |]; auto using still_row. Qed.
Lemma along_rel k : Forall2 (pair R) (along s c k) (along t c k). Proof. unfold along, pair; go. Qed.
Lemma near_rel i k : L2 (near s c i k) (near t c i k).
Proof.
  unfold near; apply (each_rel (dual s) (dual t) (pair R)); [| apply along_rel]; intros f a b e; pose proof dual_keeps as k2.
  apply (madd_rel (dual s) (dual t) (pair R) k2); [apply (unit_rel (dual s) (dual t) (pair R) k2) |].
  apply (scaled_rel (dual s) (dual t) (pair R) k2); [apply (whole_rel (dual s) (dual t) (pair R) k2) | apply (hat_rel (dual s) (dual t) (pair R) k2); auto].
Qed.
Lemma lagrangian_rel f f' g g' w w' : L2 f f' -> L2 g g' -> L2 w w' -> R (lagrangian s c v f g w) (lagrangian t c x f' g' w').
Proof.
  intros; unfold lagrangian, number_of.
  apply (entry_rel (dual s) (dual t) (pair R) dual_keeps _ _ 0 0), value_rel; [exact dual_keeps |].
  apply scope_rel; auto using dual_keeps, still_rel, h_rel; apply still_row; apply v_rel.
Qed.
Lemma works_rel w w' a a' b b' : L w w' -> V a a' -> V b b' -> R (works s c v w a b) (works t c x w' a' b').
Proof. intros; unfold works; go; apply scope_rel; auto using h_rel, p_rel, F_rel, G_rel. Qed.
Definition products2 := products_rel (dual s) (dual t) (pair R) dual_keeps.
Definition all_moved2 := all_moved_rel (dual s) (dual t) (pair R) dual_keeps.
Lemma before_rel : V (before s c v) (before t c x).
Proof.
  unfold before; apply seq_rel; auto; intro; apply sub_rel; auto; [| apply works_rel; auto using w_rel, axis_rel, none_rel].
  apply lagrangian_rel; [apply products2 | apply products2 | apply all_moved2]; auto using near_rel, stills_rel, F_rel, G_rel, w_rel.
Qed.
Lemma after_rel : V (after s c v) (after t c x).
Proof.
  unfold after; apply seq_rel; auto; intro; apply add_rel; auto; [| apply works_rel; auto using w_rel, axis_rel, none_rel].
  apply lagrangian_rel; [apply products2 | apply products2 |]; auto using near_rel, stills_rel, F_rel, G_rel, w_rel.
Qed.
Hint Resolve h_rel v_rel p_rel none_rel ones_rel axis_rel F_rel G_rel w_rel other_rel g_rel g_back_rel before_rel after_rel kick_rel ended_rel
  flat_rel works_rel arrays_rel system_rel keeps given : rel.

Lemma increments_rel : agree (increments s c v) (increments t c x).
Proof. unfold increments; split; cbn [fst snd]; go; auto with rel; apply flat_rel; go; auto with rel; unfold y; go. Qed.
Lemma work_rel : agree (work s c v) (work t c x).
Proof. unfold work, eta, eta_next; split; cbn [fst snd]; go; apply works_rel; auto with rel. Qed.
Lemma targets_rel : agree (targets s c v) (targets t c x).
Proof. unfold targets, mu; split; cbn [fst snd]; go; auto with rel. Qed.
Lemma scale_rel w w' : L w w' -> V (scale s c v w) (scale t c x w').
Proof. intro; unfold scale; go; auto with rel. Qed.
Lemma weight_rel : R (weight s c v) (weight t c x).
Proof. unfold weight, y; apply fold_rel with (Q := R); go. Qed.
Hint Resolve scale_rel weight_rel : rel.
Lemma scales_rel : agree (scales s c v) (scales t c x).
Proof. unfold scales; split; cbn [fst snd]; go; auto with rel; eapply (map_rel R R); go; auto with rel. Qed.
Lemma residual_rel : agree (residual s c v) (residual t c x).
Proof. unfold residual, y, a; split; cbn [fst snd]; go; auto with rel; eapply (map_rel R R); go; auto with rel. Qed.
Lemma jacobian_rel : agree (jacobian s c v) (jacobian t c x).
Proof.
  unfold jacobian, y, a; split; cbn [fst snd]; auto with rel; cbn zeta; apply concat_rel, tab_rel; auto; intros; apply at_rel; auto.
  apply row_rel; auto; apply seq_rel; auto; intro; eapply (map_rel (pair R) R); [| intros ? ? e; exact (proj2 e)].
  apply (system_rel (dual s) (dual t) (pair R)); auto using dual_keeps, stills_rel, still_row with rel.
  - unfold still_; eapply map_rel; [exact given |]; auto using still_row.
  - apply (zip_rel (dual s) (dual t) (pair R) dual_keeps); auto using still_row, along_rel with rel.
    intros; apply (add_rel (dual s) (dual t) (pair R) dual_keeps); auto.
Qed.
Lemma update_rel : agree (update s c v) (update t c x).
Proof.
  assert (e : V (run_after s (newton c) (unknowns c + unknowns c * unknowns c) (unknowns c) (nth 13 v []) (arrays s c v (y s v) (a s v) (none s c) (w s c v) []))
                (run_after t (newton c) (unknowns c + unknowns c * unknowns c) (unknowns c) (nth 13 x []) (arrays t c x (y t x) (a t x) (none t c) (w t c x) [])))
    by (unfold y, a; apply run_after_rel; auto using v_rel; apply arrays_rel; auto using v_rel, none_rel, w_rel).
  unfold update; split; cbn [fst snd]; go; exact e.
Qed.
Lemma attitude_rel : agree (attitude s c v) (attitude t c x).
Proof. unfold attitude, a, mu; split; cbn [fst snd]; go; auto with rel; apply flat_rel; go; auto with rel. Qed.
Lemma momentum_rel : agree (momentum s c v) (momentum t c x).
Proof. unfold momentum; split; cbn [fst snd]; auto with rel; apply ended_rel; go; auto with rel. Qed.
Lemma transport_rel : agree (transport s c v) (transport t c x).
Proof. unfold transport, a, mu, eta; split; cbn [fst snd]; go; try apply ended_rel; go; auto with rel. Qed.
Lemma advected_rel : agree (advected_ s c v) (advected_ t c x).
Proof.
  assert (e : V (stored s (advected c) (all_moved s (F s c v) (G s c v) (advected c) (w s c v)))
                (stored t (advected c) (all_moved t (F t c x) (G t c x) (advected c) (w t c x)))) by (go; auto with rel).
  unfold advected_, a, mu; split; cbn [fst snd]; auto; rewrite (length_rel _ _ _ e); auto with rel.
Qed.
Lemma guess_rel : agree (guess s c v) (guess t c x).
Proof.
  assert (e : V (stored s (advected c) (w s c v)) (stored t (advected c) (w t c x))) by (go; auto with rel).
  unfold guess, history, y, a, mu; cbn zeta; split; cbn [fst snd]; [rewrite (length_rel _ _ _ e); auto with rel | go].
Qed.
Lemma checks_rel : agree (checks s c v) (checks t c x).
Proof.
  assert (e : V (stored s (advected c) (w s c v)) (stored t (advected c) (w t c x))) by (go; auto with rel).
  unfold checks; rewrite (length_rel _ _ _ e); cbn zeta; match goal with |- context [ended s c v _ (_ + S (length ?far))] =>
    match goal with |- context [ended t c x _ (_ + S (length ?far_))] => assert (d : V far far_) end end.
  - apply flat_rel, each_rel; [| unfold y; apply v_rel; auto]; intros f i j same; destruct (distance f) as [[k z] |]; repeat constructor.
    assert (m : M (map (firstn k) (hat s f i)) (map (firstn k) (hat t f j))) by
      (eapply map_rel; [apply hat_rel; eassumption | intros; apply firstn_rel; assumption]).
    apply mul_rel; auto; [apply ratio_rel | apply inner_rel]; auto.
  - rewrite (length_rel _ _ _ d); unfold a, mu; split; cbn [fst snd]; [apply skipn_rel, ended_rel; auto using v_rel |].
    constructor; auto; eapply fold_rel; [apply firstn_rel, ended_rel; auto using v_rel | intros; apply add_rel; auto | apply whole_rel; auto].
Qed.
Lemma at_attitude_rel : agree (at_attitude s c v) (at_attitude t c x).
Proof.
  unfold at_attitude; cbn zeta; match goal with |- agree (_, ?there) (_, ?there_) => assert (e : V there there_) end.
  - go; auto with rel; destruct (in_space _); go; unfold p; go.
  - split; cbn [fst snd]; auto; rewrite (length_rel _ _ _ e); apply run_rel; auto; apply arrays_rel; auto with rel.
Qed.
End Claims.

(* A claim by its name. *)
Inductive name := Increments | Work | Target | Scales | Residual | Jacobian | Update | Attitude | Momentum | Transport | Advected | Guess | Checks | Seen.
Definition claimed (k : name) : claim :=
  match k with
  | Increments => increments | Work => work | Target => targets | Scales => scales | Residual => residual | Jacobian => jacobian | Update => update
  | Attitude => attitude | Momentum => momentum | Transport => transport | Advected => advected_ | Guess => guess | Checks => checks | Seen => at_attitude
  end.
Lemma claimed_rel k s t R (keeps : related s t R) c v x : Forall2 (Forall2 R) v x -> agree s t R (claimed k s c v) (claimed k t c x).
Proof.
  intro; destruct k; cbn [claimed];
    auto using increments_rel, work_rel, targets_rel, scales_rel, residual_rel, jacobian_rel, update_rel, attitude_rel, momentum_rel, transport_rel,
      advected_rel, guess_rel, checks_rel, at_attitude_rel.
Qed.

(* The check *)

(* Places of the variables, and what stands below: numbers of the variables, each array a column; and rules for functions. *)
Record problem := {
  step : certificate;
  places : list (list positive);
  divisors : list text;
  a_point : list Z;
  some_primes : list Z;
  rules : list rule
}.

Definition names (o : ops) (v : list (list (T o))) : list (list (list (T o))) := map (column o) v.
Definition variables : list (list positive) -> list (list frac) := map (map var).
Definition with_divisors (l : list poly) (c : problem) : below :=
  {| polynomials := l; point := a_point c; primes := some_primes c; roots := []; known := [] |}.
Definition above (f : frac) : poly := match f with Known p [] => p | _ => pc 1 end.
Definition of_text (c : problem) (l : below) (t : text) : frac :=
  number_of (fractions l) t (names (fractions l) (variables (places c))).
Definition place (c : problem) (k : nat) : positive := nth k (nth 12 (places c) []) 1%positive.

(* A root's square is a polynomial, and that of the rule. *)
Definition root_of (c : problem) (l : below) (r : rule) : list (positive * poly) :=
  match r with
  | RootAt a b s k =>
      let o := fractions l in let b := of_text c l b in
      match of_text c l s with
      | Known p [] =>
          if Nat.ltb k (length (nth 12 (places c) [])) && alike l (Known p []) (mul o (mul o (of_text c l a) b) b) then [(place c k, p)] else []
      | _ => []
      end
  | _ => []
  end.
Definition grown (c : problem) (l : below) (r : rule) : below := {|
  polynomials := polynomials l; point := point l; primes := primes l;
  roots := root_of c l r ++ roots l;
  known := calls (fractions l) r (names (fractions l) (variables (places c))) ++ known l
|}.
Definition below_of (c : problem) : below :=
  fold_left (grown c) (rules c) (with_divisors (map (fun d => above (of_text c (with_divisors [] c) d)) (divisors c)) c).

(* What is found of a claim: nothing, where a number isn't known, as something is divided by what isn't a product of the divisors. *)
Inductive verdict := Holds | Wrong | Open.
Definition is_known (f : frac) : bool := match f with Known _ _ => true | Unknown _ => false end.
Definition found (c : problem) (k : name) : verdict :=
  let l := below_of c in
  let e := claimed k (fractions l) (step c) (variables (places c)) in
  if Nat.eqb (length (fst e)) (length (snd e)) && forallb (fun p => alike l (fst p) (snd p)) (combine (fst e) (snd e)) then Holds
  else if forallb is_known (fst e) && forallb is_known (snd e) then Wrong else Open.

(* Reasons why numbers of a claim aren't known, with polynomials as lists of terms. Sums and products of many terms are left out: a divisor,
   or the argument of a function, has few. *)
Fixpoint terms (p : poly) (j : positive) (m : list (positive * positive)) : list (Z * list (positive * positive)) :=
  match p with
  | Pc z => if (z =? 0)%Z then [] else [(z, m)]
  | Pinj i q => terms q (i + j) m
  | PX q i r => terms q j ((j, i) :: m) ++ terms r (1 + j) m
  end.
(* A function by a number and its order. *)
Definition code (f : function) : nat * nat :=
  match f with
  | Sqrt => (1, 0) | Sin => (2, 0) | Cos => (3, 0) | Exp => (4, 0) | Ln => (5, 0) | Stumpff k => (6, k) | LogRatio k => (7, k)
  end.
Fixpoint size_of (p : poly) : N := match p with Pc _ => 1 | Pinj _ q => size_of q | PX q _ r => size_of q + size_of r end.
Definition is_short (most : N) (of : N -> N -> N) (f g : frac) : bool :=
  match f, g with Known p _, Known q _ => N.leb (of (size_of p) (size_of q)) most | _, _ => true end.
Definition short (most : N) (l : below) : ops := let o := fractions l in {|
  T := frac; whole := whole o; div := div o;
  add f g := if is_short most N.add f g then add o f g else Unknown Idle;
  sub f g := if is_short most N.add f g then sub o f g else Unknown Idle;
  opp := opp o; call := call o; idle := idle o;
  mul f g := if is_short most N.mul f g then mul o f g else Unknown Idle
|}.
Definition same_reason (a b : reason) : bool :=
  match a, b with
  | Below p, Below q => peq p q
  | Call f p _, Call g q _ => same_function f g && peq p q
  | _, _ => false
  end.
Definition added (l : list reason) (f : frac) : list reason :=
  match f with Known _ _ | Unknown Idle => l | Unknown r => if existsb (same_reason r) l then l else r :: l end.
Definition asked (most : N) (c : problem) (l : list name) : list ((nat * nat) * list (Z * list (positive * positive)) * powers) :=
  let b := below_of c in
  let all := flat_map (fun k => let e := claimed k (short most b) (step c) (variables (places c)) in fst e ++ snd e) l in
  map (fun r => match r with Call f p d => (code f, terms p 1 [], d) | Below p => (0, 0, terms p 1 [], []) | Idle => (0, 0, [], []) end)
    (fold_left added all []).

Section Sound.
Variable K : Type.
Variables (k0 k1 : K) (kadd kmul ksub kdiv : K -> K -> K) (kopp kinv : K -> K).
Variable theory : field_theory k0 k1 kadd kmul ksub kopp kdiv kinv (@eq K).
Add Field field_of_K : theory.
Variable apply : function -> K -> K.
Definition field := numbers K k0 k1 kadd kmul ksub kdiv kopp apply.
Definition values (env : list K) : list (list positive) -> list (list K) := map (map (fun j => BinList.nth k0 j env)).

(* The unknowns of functions have the values of the rules. *)
Definition obeyed (v : list (list (list K))) (r : rule) : Prop :=
  Forall (fun c => apply (fst (fst c)) (snd (fst c)) = snd c) (calls field r v) /\
  match r with
  | RootAt a b _ k => let b := number_of field b v in
      kmul (unknown field v k) (unknown field v k) = kmul (kmul (number_of field a v) b) b
  | _ => True
  end.

(* In each field, for all functions and numbers of the variables that obey the rules and at which what stands below isn't zero, the
   equation of the claim. *)
Definition holds (c : problem) (k : name) : Prop := forall env,
  Forall (fun d => number_of field d (names field (values env (places c))) <> k0) (divisors c) ->
  Forall (obeyed (names field (values env (places c)))) (rules c) ->
  let e := claimed k field (step c) (values env (places c)) in fst e = snd e.

Section Environment.
Variable c : problem.
Variable env : list K.
Notation ev := (ev K k0 k1 kadd kmul kopp env).
Notation means := (means K k0 k1 kadd kmul kopp env).
Notation v := (values env (places c)).
Definition good (l : below) : Prop :=
  Forall (fun p => ev p <> k0) (polynomials l) /\ Forall (lawful K k0 k1 kadd kmul kopp env) (roots l) /\
  Forall (true_call K k0 k1 kadd kmul kopp apply env l) (known l).
Lemma keeps l : good l -> related (fractions l) field (means l).
Proof. intros [d [r k]]; apply (fractions_related K k0 k1 kadd kmul ksub kdiv kopp kinv theory); auto. Qed.
Lemma variables_mean l : Forall2 (Forall2 (means l)) (variables (places c)) v.
Proof. apply map_same; intro; apply map_same; intro; apply (var_ok K k0 k1 kadd kmul ksub kdiv kopp kinv theory). Qed.
Lemma names_mean l : Forall2 (Forall2 (Forall2 (means l))) (names (fractions l) (variables (places c))) (names field v).
Proof. unfold names; eapply map_rel; [apply variables_mean |]; intros ? ? same; apply (column_rel (fractions l) field (means l)); exact same. Qed.
Lemma text_means l t : good l -> means l (of_text c l t) (number_of field t (names field v)).
Proof. intro g; apply (number_rel _ _ _ (keeps l g)), names_mean. Qed.
Lemma place_means k : k < length (nth 12 (places c) []) -> unknown field (names field v) k = BinList.nth k0 (place c k) env.
Proof.
  intro h; unfold unknown, place, entry, at_.
  assert (n : nth 12 (names field v) [] = column field (map (fun j => BinList.nth k0 j env) (nth 12 (places c) []))).
  { etransitivity; [exact (map_nth (column field) v [] 12) |]; f_equal; exact (map_nth _ (places c) [] 12). }
  rewrite n; clear n; revert k h; induction (nth 12 (places c) []) as [| j l IH]; intros [| k] h; cbn in h; try lia; [reflexivity |].
  apply (IH k); lia.
Qed.
Lemma root_good l r : good l -> obeyed (names field v) r -> Forall (lawful K k0 k1 kadd kmul kopp env) (root_of c l r).
Proof.
  intros g [_ o]; destruct r as [a b s k | | | | | |]; cbn [root_of]; auto; pose proof (keeps l g) as kept.
  destruct (of_text c l s) as [p [|] |]; auto; destruct (_ && _) eqn:e; auto; apply andb_true_iff in e; destruct e as [t e].
  apply Nat.ltb_lt in t; constructor; auto; unfold lawful; cbn [fst snd]; cbn zeta in o; rewrite place_means in o by exact t; rewrite o; destruct g as [d [q h]].
  assert (m : means l (Known p []) (ev p)) by (change (ev p = kmul (ev p) (ev (under_ (polynomials l) []))); rewrite (nothing K k0 k1 kadd kmul kopp); ring).
  symmetry; refine (alike_ok K k0 k1 kadd kmul ksub kdiv kopp kinv theory env l _ _ _ _ _ m _ e); auto.
  apply (of_mul _ _ _ kept); [apply (of_mul _ _ _ kept) |]; apply text_means; repeat split; auto.
Qed.
Lemma grown_good l r : good l -> obeyed (names field v) r -> good (grown c l r).
Proof.
  intros g o; pose proof (root_good l r g o) as new; pose proof (calls_rel _ _ _ (keeps l g) r _ _ (names_mean l)) as same.
  destruct g as [d [q h]], o as [o _]; repeat split; cbn [grown polynomials roots known]; auto; apply Forall_app; split; auto.
  clear - same o; induction same as [| [[f a] x] [[g b] y] m n [e [i j]] _ IH]; constructor; [| apply IH; inversion o; auto].
  cbn in e, i, j; subst g; exists b; split; auto; inversion o as [| ? ? here]; cbn in here; rewrite here; exact j.
Qed.
End Environment.

Theorem sound c k : found c k = Holds -> holds c k.
Proof.
  unfold found, holds; cbn zeta; intros e env not_zero obey; destruct (_ && _) eqn:is in e; [clear e; rename is into e | exfalso; revert e; destruct (forallb is_known _ && forallb is_known _); discriminate].
  apply andb_true_iff in e; destruct e as [n e]; apply Nat.eqb_eq in n.
  assert (g : good env (below_of c)).
  { unfold below_of; match goal with |- good _ (fold_left _ _ ?start) => assert (g : good env start) end.
    - repeat split; cbn [with_divisors polynomials roots known]; auto.
      induction not_zero as [| d l z _ IH]; cbn [map]; constructor; auto.
      assert (m := text_means c env (with_divisors [] c) d (conj (Forall_nil _) (conj (Forall_nil _) (Forall_nil _)))).
      destruct (of_text c (with_divisors [] c) d) as [p [| i q] |]; try exact (F_1_neq_0 theory).
      cbn [above]; intro w; apply z; transitivity (ev K k0 k1 kadd kmul kopp env p); [| exact w].
      symmetry; etransitivity; [exact m |]; generalize (number_of field d (names field (values env (places c)))).
      intro u; change K in u; change (kmul u k1 = u); ring.
    - revert g; generalize (with_divisors (map (fun d => above (of_text c (with_divisors [] c) d)) (divisors c)) c).
      induction obey as [| r rest o _ IH]; cbn [fold_left]; intros l g; auto; apply IH, grown_good; auto. }
  destruct (claimed_rel k (fractions (below_of c)) field _ (keeps env _ g) (step c) _ _ (variables_mean c env _)) as [left right].
  destruct g as [d [q h]].
  eapply (all_alike K k0 k1 kadd kmul ksub kdiv kopp kinv theory env (below_of c)); eauto.
Qed.
End Sound.
